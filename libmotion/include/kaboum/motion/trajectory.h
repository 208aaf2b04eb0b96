#pragma once

#include <kaboum/robot/path.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::motion {

class TimeLaw;
struct PathPiece;

/// Bounds on the speed of each variable. Above 0. [rad/s or length/s; the same per s, and per s²]
struct SpeedLimits {
  std::vector<double> velocity, acceleration;
  std::vector<double> jerk = {};  ///< of blended trajectories only
};

/// Values of the variables at an instant, and their derivatives by time.
struct Instant {
  std::vector<double> q, velocity, acceleration;
};

/// Profile by which the share of a segment that is done grows.
enum class Profile {
  Quintic,   ///< a polynomial of degree 5: twice continuously differentiable
  Trapezoid  ///< of velocity: the fastest that keeps the limits; its accelerations jump
};

/// A path in time. From rest to rest along each straight segment, as fast as limits and profile
/// allow: its points are those of the path, in their order, so what is free at every instant of the
/// path is free at every instant of this (docs/algorithms/motion-planning.md#execution).
/// Or with blended corners, without stops at them: its points are means over a short time of those
/// of a BlendedPath.
class Trajectory {
 public:
  /// @param rate  of the controller: waypoints are reached at whole multiples of 1 / rate, so that
  ///   straight lines between samples stay on the path as well. [1/s]
  /// @throws Error{InvalidArgument} for an empty path, waypoints that are not finite or differ in
  ///   their number of values, limits and rates that are not above 0; Error{LimitReached} when it
  ///   would take more than 1e8 samples.
  Trajectory(robot::Path path, const SpeedLimits& limits, double rate,
             Profile profile = Profile::Quintic);
  /// With blended corners. Values, velocities and accelerations are continuous; velocities,
  /// accelerations and jerks are within the limits at every instant
  /// (docs/algorithms/motion-planning.md#blended-corners).
  /// @param shares  of each waypoint, as of BlendedPath. Where the path stops is a sample.
  /// @throws as the other one, of limits of jerk as well; as BlendedPath.
  Trajectory(robot::Path path, const std::vector<double>& shares, const SpeedLimits& limits,
             double rate);

  /// Number of samples, both ends included: sample k is at k / rate.
  [[nodiscard]] std::size_t samples() const { return first_.back() + 1; }
  [[nodiscard]] double duration() const {
    return static_cast<double>(first_.back()) / rate_;
  }  ///< [s]
  /// Time at which a waypoint is reached; of a corner with a blend, the middle of the time that the
  /// blend takes. [s]
  [[nodiscard]] double time_at(std::size_t waypoint) const;
  /// @pre 0 ≤ time ≤ duration. [s]
  [[nodiscard]] Instant at(double time) const { return at_step(time * rate_); }
  /// Values of sample k; waypoints exactly where it stops.
  [[nodiscard]] std::vector<double> sample(std::size_t k) const;
  /// Sample k with its derivatives, which are 0 where it stops: at the ends and, without blends, at
  /// all waypoints.
  [[nodiscard]] Instant instant(std::size_t k) const;
  /// First and last sample of each stretch in which the curve, or cubic and quintic polynomials
  /// through the samples, may leave the straight lines between samples: those of blends, and next
  /// to stops those in which such a polynomial may go beyond the stop. Ascending, apart from each
  /// other; none of trajectories without blends. Elsewhere curve and polynomials between two
  /// samples that follow each other are on one segment of the path.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> bends() const;
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] const robot::Path& path() const { return path_; }

 private:
  struct Blended;

  void require_valid(const SpeedLimits& limits) const;
  void append_steps(double time);
  void add_overshoots(const TimeLaw& law, std::span<const PathPiece> pieces, double stretch,
                      const SpeedLimits& limits,
                      std::vector<std::pair<std::size_t, std::size_t>>& bends) const;
  [[nodiscard]] std::size_t segment_of(double step) const;
  [[nodiscard]] Instant at_step(double step) const;
  [[nodiscard]] Instant blended_at(double step) const;

  robot::Path path_;
  double rate_;
  Profile profile_ = Profile::Quintic;
  std::vector<std::size_t> first_;  ///< sample at each waypoint; with blends, at each stop
  /// For each segment, with a trapezoid: the part of its time for which it accelerates.
  std::vector<double> ramp_;
  std::shared_ptr<const Blended> blended_;  ///< null: it stops at all waypoints
};

enum class AngleUnit { Radians, Degrees };

/// Samples as a CSV that `robot::parse_path_csv` reads: a column time_from_start [s], one for each
/// variable; numbers as short as they can be and read back the same. Degrees are those of
/// robot::to_degrees.
std::string to_csv(const Trajectory& trajectory, const robot::Robot& robot,
                   AngleUnit unit = AngleUnit::Radians);
/// Waypoints alike, without times.
std::string to_csv(const robot::Path& path, const robot::Robot& robot,
                   AngleUnit unit = AngleUnit::Radians);

/// Texts of messages of ROS.
enum class MessageFormat { Json, Yaml };

/// That of a file of samples, by its name: .json, .yaml, .yml, in whatever case; nullopt: it is a
/// CSV.
std::optional<MessageFormat> message_format(const std::string& file);

/// Samples as a trajectory_msgs/JointTrajectory of ROS 2: joint_names, and points with positions,
/// velocities, accelerations and time_from_start (sec, nanosec). YAML as `ros2 topic pub` reads it;
/// both are read by robot::read_path. Positions are the numbers of to_csv, in radians and metres.
/// @throws Error{LimitReached} where it takes 2³¹ s or more
std::string to_joint_trajectory(const Trajectory& trajectory, const robot::Robot& robot,
                                MessageFormat format);

}  // namespace kaboum::motion
