#pragma once

#include <kaboum/base/option.h>
#include <kaboum/robot/path_file.h>

namespace kaboum::robot {

/// The options of reading a path: joint, degrees, ignore-limits.
const std::vector<Option<PathOptions>>& path_options();

/// The option of where a robot's root stands, as parse_pose takes it; its request has a text.
OptionDescription base_pose_option();

}  // namespace kaboum::robot
