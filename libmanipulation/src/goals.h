#pragma once

#include <kaboum/world/world.h>

#include <cstdint>
#include <string>

namespace kaboum::manipulation {

/// Configurations of a robot that bring a link to a pose.
struct Goals {
  std::vector<std::vector<double>> configurations;  ///< as words keep them; within the limits
  /// Nothing else reaches the poses, whole turns apart, up to the accuracy of closed forms: there
  /// is no joint that is free, or nearly, and no search that may have missed one.
  bool all = true;
  bool alone = true;        ///< the robot has no joints but those that move the link
  std::string listed = {};  ///< what of the scene they are for: "the 4 grasps …"; empty: one pose

  /// "none of the 4 grasps …"
  [[nodiscard]] std::string none() const {
    return (listed.starts_with("the only") ? "not even " : "none of ") + listed;
  }
};

/// Of what is drawn, as many are choices that a search may prefer.
inline constexpr std::size_t kChoices = 8;

/// The one of 0 … n − 1 that a choice prefers: all of them for the choices 1 … n, what is near in a
/// list far apart in time. @pre choice ≥ 1, n ≥ 1
std::size_t spread(unsigned choice, std::size_t n);

/// How goals are looked for.
struct GoalSearch {
  std::uint64_t seed = 1;  ///< where the arm has no closed form
  /// Of families with a free joint: more configurations are taken from them.
  unsigned attempt = 0;
  /// Whether it is only asked if there is one: where the arm has no closed form, one is found.
  bool any = false;
};

/// Adds those for a pose of a link in the world. Joints that do not move the link stay as in
/// `from`; of configurations that differ by whole turns, the nearest to it is taken. Where a joint
/// is free, configurations evenly spread over its range are; of an arm with more than six axes,
/// whose configurations are a family, as many at random.
void add_goals(Goals& goals, const world::RobotModel& robot, std::uint32_t link,
               const world::Transform& target, const std::vector<double>& from,
               const GoalSearch& search);

}  // namespace kaboum::manipulation
