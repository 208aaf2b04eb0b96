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
  /// Most of a segment, 0 to kMostBlend, that a blend of a corner at its end takes, and a half
  /// where two are on one; 0: none, it stops.
  double blend = 0;
  /// By joint; the empty name is of all joints that are not named. [rad/s or m/s; the same per s,
  /// and per s²]
  std::map<std::string, double> velocities = {}, accelerations = {}, jerks = {};
};

/// The options of a trajectory: time-optimal, rate, blend, max-velocity, max-acceleration,
/// max-jerk.
const std::vector<Option<TrajectoryOptions>>& trajectory_options();

/// Limits of each variable; of jerk where corners are blended. Velocities are never above those of
/// the robot's file.
/// @throws Error{InvalidArgument} for values that are not above 0, names of no joint, one joint's
///   velocity above the file's, jerks without blends, and blends of time-optimal trajectories
SpeedLimits speed_limits(const TrajectoryOptions& options, const robot::Robot& robot);

}  // namespace kaboum::motion
