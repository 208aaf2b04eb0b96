#pragma once

#include <kaboum/robot/path.h>
#include <kaboum/world/world.h>

#include <cstdint>
#include <functional>
#include <string>

namespace kaboum::motion {

/// Configurations of a robot at which a tool has a pose.
struct PoseGoals {
  robot::Path configurations;  ///< within the limits, whole turns apart counted; others' values are
                               ///< those of the start
  bool complete = false;       ///< there are no others, for certain
  std::string why;             ///< they need not be all
};

/// All configurations with which the chain from a robot's root to a tool reaches a pose: in closed
/// form where there is one, with some of each family that a free joint makes, else those that a
/// numeric search finds (kinematics::find_configurations).
/// @param tool  a frame of the robot
/// @param pose  of the tool in the world
/// @param start  a value per variable; those of joints outside the chain are kept
/// @throws Error{InvalidArgument} as kinematics::arm_of
PoseGoals pose_goals(const world::RobotModel& robot, const world::ToolFrame& tool,
                     const geom::Transform& pose, const std::vector<double>& start,
                     std::uint64_t seed,
                     const std::function<void(const std::string&)>& progress = {});

}  // namespace kaboum::motion
