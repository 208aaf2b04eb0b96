#pragma once

#include <kaboum/world/world.h>

#include <cstdint>
#include <string>

namespace kaboum::manipulation {

/// Configurations of a robot that bring a link to a pose.
struct Goals {
  std::vector<std::vector<double>> configurations;  ///< as words keep them; within the limits
  bool all = true;  ///< there are no others, whole turns apart, up to the accuracy of closed forms
};

/// Adds those for a pose of a link in the world. Joints that do not move the link stay as in
/// `from`; of configurations that differ by whole turns, the nearest to it is taken.
/// @param seed  of the search, where the arm has no closed form.
void add_goals(Goals& goals, const world::RobotModel& robot, std::uint32_t link,
               const world::Transform& target, const std::vector<double>& from, std::uint64_t seed);

}  // namespace kaboum::manipulation
