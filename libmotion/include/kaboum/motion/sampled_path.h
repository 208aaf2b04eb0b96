#pragma once

#include <kaboum/motion/path_constraint.h>
#include <kaboum/motion/trajectory_options.h>
#include <kaboum/world/motion_check.h>

#include <functional>
#include <span>

namespace kaboum::motion {

/// Samples of a path over time, and their text.
struct SampledPath {
  Trajectory trajectory;
  SpeedLimits limits;
  std::string csv;  ///< as motion::to_csv
  /// Share of its segments that each waypoint's blend takes (BlendedPath), as far as it was
  /// certified; 0: it stops there. Empty without blends.
  std::vector<double> blends;
  /// Farthest that each variable may be from the straight line between two samples that follow each
  /// other, on the curve that they are taken of: its acceleration's limit / (8 rate²); 0 without
  /// blends. [rad or length]
  std::vector<double> between_samples;
};

/// Who moves where: what paths are decided in.
struct MovingRobot {
  const world::Checker& checker;
  const world::WorldState& state;
  std::size_t robot = 0;
  std::span<const PathConstraint> constraints = {};  ///< that it keeps

  [[nodiscard]] const robot::Robot& kinematics() const;
};

/// The path that a text of to_csv stands for, read as any program reads it, within the limits of
/// the joints.
/// @throws Error{InvalidInput}
robot::Path parse_path(const std::string& csv, const robot::Robot& robot, AngleUnit unit);

/// Decides that a path is free at every instant, and keeps the constraints.
/// @param resolution  to which the path was decided before, above 0: this is 1000 times finer, for
///   what was decided is not to be refused for a rounding [rad or length]
/// @param what  of the path, in messages: "the samples"
/// @throws Error{LimitReached} where it is not, or cannot be decided
void require_free(const MovingRobot& moving, const robot::Path& path, double resolution,
                  const std::string& what,
                  const std::function<void(const std::string&)>& progress = {});

/// Samples a path in time. The samples, as they are read from the text, were decided free. A blend
/// that is not is halved, and after five times left out; so is one, of several, that is nearest in
/// time to samples that are not.
/// @throws as speed_limits, Trajectory, require_free; Error{LimitReached} for more than 5,000,000
///   samples
SampledPath sample_path(const MovingRobot& moving, const robot::Path& path,
                        const TrajectoryOptions& options, double resolution,
                        AngleUnit unit = AngleUnit::Radians,
                        const std::function<void(const std::string&)>& progress = {});

}  // namespace kaboum::motion
