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

/// The direction of a frame fixed to a link that is to stay near the vertical.
struct Upright {
  std::uint32_t link = 0;
  geom::Vec3 up;     ///< of unit length, in the link's frame
  double angle = 0;  ///< most that it may lean [rad]
};

/// Whether the direction leans by no more than the angle at every instant of a path: in a stretch
/// of a segment it leans by no more than in the middle and as much as all joints that turn the link
/// turn in half of it; stretches of which that does not decide are halved
/// (docs/planning/geometry.md#upright). false also where halving ends.
bool stays_upright(const world::RobotModel& robot, const robot::Path& path, const Upright& upright);

}  // namespace kaboum::manipulation
