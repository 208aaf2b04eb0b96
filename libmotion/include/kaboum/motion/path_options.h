#pragma once

#include <kaboum/base/option.h>
#include <kaboum/motion/find_path.h>

namespace kaboum::motion {

/// The options of a search for a path.
const std::vector<Option<PathOptions>>& path_options();

}  // namespace kaboum::motion
