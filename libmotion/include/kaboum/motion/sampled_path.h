#pragma once

#include <kaboum/motion/path_constraint.h>
#include <kaboum/motion/trajectory_options.h>
#include <kaboum/world/motion_check.h>

#include <functional>
#include <optional>
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
  /// How far each variable may be from the straight line between two samples that follow each
  /// other, where corners are blended: all within that was certified. 3/16 of its acceleration's
  /// limit / rate²: neither the curve nor what a controller makes of its samples by polynomials of
  /// degree 3 or 5 is farther. 0 without blends. [rad or length]
  std::vector<double> between_samples;
};

/// Who moves where: what paths are decided in.
struct MovingRobot {
  const world::Checker& checker;
  const world::WorldState& state;
  std::size_t robot = 0;
  std::span<const PathConstraint> constraints = {};  ///< that it keeps
  /// How far each variable may be from its line everywhere, as world::MotionOptions::around: of
  /// fingers that stop where they touch.
  std::vector<double> around = {};

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

/// Shares of its segments that blends of a path's corners take, of each waypoint: not above those
/// that are asked for, and such that the trajectory is free at every instant and keeps the
/// constraints: the straight lines between its samples and, where it is bent, all within
/// `between_samples` of them (docs/algorithms/motion-planning.md#blended-corners). A blend that is
/// not is made smaller by a quarter, and below 1/32 left out; so is one, of several, that is
/// nearest in time to where the whole is not.
/// @param asked  0 to kMostBlend, of each waypoint; of those between other corners at most 1/2
/// counts
/// @param resolution  as of require_free
/// @return nullopt: without blends it is not free either, for certain
/// @throws as Trajectory, check_motion; Error{LimitReached} for more than 5,000,000 samples
std::optional<std::vector<double>> certified_blends(
    const MovingRobot& moving, const robot::Path& path, const SpeedLimits& limits,
    const std::vector<double>& asked, double rate, double resolution,
    const std::function<void(const std::string&)>& progress = {});

/// SampledPath::between_samples of a trajectory with blends.
std::vector<double> room_between_samples(const SpeedLimits& limits, double rate);

/// Samples a path in time. The samples, as they are read from the text, were decided free,
/// with the room between them (certified_blends).
/// @throws as speed_limits, Trajectory, require_free; Error{LimitReached} for more than 5,000,000
///   samples
SampledPath sample_path(const MovingRobot& moving, const robot::Path& path,
                        const TrajectoryOptions& options, double resolution,
                        AngleUnit unit = AngleUnit::Radians,
                        const std::function<void(const std::string&)>& progress = {});

}  // namespace kaboum::motion
