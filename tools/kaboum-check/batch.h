#pragma once

#include <kaboum/world/scene.h>

#include <functional>
#include <string>

#include "options.h"

/// kaboum-check --batch: many configurations or motions of one robot, free or not.
namespace kaboum::tools {

/// @throws Error{InvalidArgument} for options that mean nothing with, or without, a batch.
void require_batch_meaning(const CheckOptions& options);

/// Values of --motions: from each row to the next one, or from the first of two rows to the second.
inline constexpr const char *kConsecutive = "consecutive", *kPairs = "pairs";

/// Decides configurations, or the motions between them.
/// @param kept  end of what is said of what is free: margins
/// @return an exit code: 0 where all are free
int check_batch(const CheckOptions& options, const world::SceneFile& scene, std::size_t robot,
                const robot::Path& rows, const std::string& kept,
                const std::function<void(const std::string&)>& say, Json& report);

}  // namespace kaboum::tools
