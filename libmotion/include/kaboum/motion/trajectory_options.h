#pragma once

#include <kaboum/base/option.h>
#include <kaboum/motion/trajectory.h>

#include <map>
#include <string>

namespace kaboum::motion {

/// How a path is carried out in time.
struct TrajectoryOptions {
  bool time_optimal = false;  ///< Profile::Trapezoid, else Quintic
  double rate = 1000;         ///< samples per second
  /// By joint; the empty name is of all joints that are not named. [rad/s or m/s; the same per s]
  std::map<std::string, double> velocities = {}, accelerations = {};
};

/// The options of a trajectory: time-optimal, rate, max-velocity, max-acceleration.
const std::vector<Option<TrajectoryOptions>>& trajectory_options();

/// Limits of each variable. Velocities are never above those of the robot's file.
/// @throws Error{InvalidArgument} for values that are not above 0, names of no joint, and one
///   joint's velocity above the file's
SpeedLimits speed_limits(const TrajectoryOptions& options, const robot::Robot& robot);

}  // namespace kaboum::motion
