#pragma once

#include <kaboum/motion/find_path.h>

#include <vector>

namespace kaboum::manipulation {

/// So little that motion::find_path only tries straight paths. [motion::PathOptions::most_work]
inline constexpr double kNoWork = 1e-9;

/// A path as motion::find_path looks for, but that leaves where the robot is straight against the
/// direction of its tool, and comes to a goal straight along it, where these short lines are free
/// (from and to its home it goes as it likes). What grasps, or is put among other things, has
/// little room for anything else, and random trees take long to find that. Not found says nothing.
///
/// @param start  the robot's configuration. @pre one that find_path can start from, as for `goals`.
motion::PathAnswer find_path_along_tool(const world::Checker& checker,
                                        const world::WorldState& state, std::size_t robot,
                                        const std::vector<double>& start,
                                        const std::vector<std::vector<double>>& goals,
                                        const motion::PathOptions& options);

}  // namespace kaboum::manipulation
