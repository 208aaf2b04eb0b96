#pragma once

#include <kaboum/world/motion_check.h>

#include <string>
#include <vector>

/// Motions of robots that hold something by grippers with joints. docs/planning/grippers.md.
namespace kaboum::world {

/// Whether any robot holds something by a gripper with joints.
bool holds_by_fingers(const WorldState& state);

/// Paths of a robot that moves, and of those that stand beside it and hold something, with room for
/// their fingers: what check_motions finds free is so wherever these stop. Empty: no finger may be
/// elsewhere than it is.
/// @param state  of the others
/// @param what  of the path, in messages: "waypoint"
/// @throws as finger_room_along
std::vector<RobotPath> paths_with_fingers(const World& world, const WorldState& state,
                                          std::size_t robot, const robot::Path& path,
                                          const std::string& what);

}  // namespace kaboum::world
