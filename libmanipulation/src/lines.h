#pragma once

#include <kaboum/robot/path.h>
#include <kaboum/world/world.h>

#include <cstdint>
#include <optional>

namespace kaboum::manipulation {

/// Waypoints whose configurations bring a link along the straight line from where it is to a pose,
/// turning evenly: inverse kinematics, continued from each to the next. Between waypoints, which
/// are at most `step` apart, the link leaves the line a little. nullopt: at some place nothing is
/// within the limits, or near the waypoint before.
/// @param to  of the link in the world.
/// @param step  [length]
std::optional<robot::Path> follow_line(const world::RobotModel& robot, std::uint32_t link,
                                       const std::vector<double>& from, const world::Transform& to,
                                       double step);

}  // namespace kaboum::manipulation
