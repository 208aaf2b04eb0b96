#pragma once

#include <kaboum/motion/path_constraint.h>
#include <kaboum/robot/path.h>
#include <kaboum/world/world.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace kaboum::motion {

/// Configurations of a robot that a motion may lead to.
struct Goals {
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
Goals pose_goals(const world::RobotModel& robot, const world::ToolFrame& tool,
                 const geom::Transform& pose, const std::vector<double>& start, std::uint64_t seed,
                 const std::function<void(const std::string&)>& progress = {});

/// Some configurations that meet constraints, drawn at random (kinematics::ConstraintSampler): each
/// is decided to be within the tolerances (check_constraints).
/// @param tool  a frame of the robot: the joints from the root to it are drawn
/// @param start  a value per variable; those of joints outside the chain are kept
/// @param most  so many at most
/// @throws Error{InvalidArgument} as kinematics::arm_of and frame_of; where a constraint is of a
///   link that does not move with the first joints of the chain, or of one that rests
Goals constraint_goals(const world::RobotModel& robot, const world::ToolFrame& tool,
                       std::span<const PathConstraint> constraints,
                       const std::vector<double>& start, std::uint64_t seed, std::size_t most = 16);

/// The same for constraints of a scene, in its first state. Where some are preferred: with all of
/// them, else without the least important one, and so on until one of the goals is free of contact.
/// @throws Error{InvalidArgument} as path_constraints
Goals preferred_goals(const world::World& world, std::size_t robot, const world::ToolFrame& tool,
                      const world::ConstraintSet& set, const std::vector<double>& start,
                      std::uint64_t seed);

}  // namespace kaboum::motion
