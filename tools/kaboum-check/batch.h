#pragma once

#include <kaboum/world/scene.h>

#include <functional>
#include <string>

#include "options.h"

/// kaboum-check --batch: many configurations of one robot, free or not.
namespace kaboum::tools {

/// @throws Error{InvalidArgument} for options that mean nothing with, or without, a batch.
void require_batch_meaning(const CheckOptions& options);

/// Configurations of a file: of NumPy's .npy, a row for each (docs/formats.md), else as those of
/// --configurations.
/// @throws Error{InvalidInput} that names the file, and the row
robot::Path read_batch(const std::string& file, const robot::Robot& robot,
                       const robot::PathOptions& options, std::vector<std::string>& notes);

/// @param kept  end of what is said of what is free: margins
/// @return an exit code: 0 where all are free
int check_batch(const CheckOptions& options, const world::SceneFile& scene, std::size_t robot,
                const robot::Path& rows, const std::string& kept,
                const std::function<void(const std::string&)>& say, Json& report);

}  // namespace kaboum::tools
