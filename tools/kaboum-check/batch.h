#pragma once

#include <kaboum/world/scene.h>

#include <functional>
#include <string>

#include "options.h"

/// kaboum-check --batch: many configurations of one robot, free or not.
namespace kaboum::tools {

/// @throws Error{InvalidArgument} for options that mean nothing with, or without, a batch.
void require_batch_meaning(const CheckOptions& options);

/// Configurations of a file: of NumPy's .npy (a row for each, float32 or float64), else as those of
/// --configurations.
robot::Path read_batch(const std::string& file, const robot::Robot& robot,
                       const robot::PathOptions& options, std::vector<std::string>& notes);

/// @return an exit code: 0 where all are free
int check_batch(const CheckOptions& options, const world::SceneFile& scene, std::size_t robot,
                const robot::Path& rows, const std::function<void(const std::string&)>& say,
                Json& report);

}  // namespace kaboum::tools
