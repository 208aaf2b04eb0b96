#pragma once

#include <kaboum/robot/path.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::motion {

/// Bounds on the speed of each variable. Above 0. [rad/s or length/s; the same per s]
struct SpeedLimits {
  std::vector<double> velocity, acceleration;
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

/// A path in time: from rest to rest along each straight segment, as fast as limits and profile
/// allow. Its points are those of the path, in their order: what is free at every instant of the
/// path is free at every instant of this (docs/algorithms/motion-planning.md#execution).
class Trajectory {
 public:
  /// @param rate  of the controller: waypoints are reached at whole multiples of 1 / rate, so that
  ///   straight lines between samples stay on the path as well. [1/s]
  /// @throws Error{InvalidArgument} for an empty path, waypoints that are not finite or differ in
  ///   their number of values, limits and rates that are not above 0; Error{LimitReached} when it
  ///   would take more than 1e8 samples.
  Trajectory(robot::Path path, const SpeedLimits& limits, double rate,
             Profile profile = Profile::Quintic);

  /// Number of samples, both ends included: sample k is at k / rate.
  [[nodiscard]] std::size_t samples() const { return first_.back() + 1; }
  [[nodiscard]] double duration() const {
    return static_cast<double>(first_.back()) / rate_;
  }  ///< [s]
  /// Time at which a waypoint is reached. [s]
  [[nodiscard]] double time_at(std::size_t waypoint) const {
    return static_cast<double>(first_.at(waypoint)) / rate_;
  }
  /// @pre 0 ≤ time ≤ duration. [s]
  [[nodiscard]] Instant at(double time) const;
  /// Values of sample k; waypoints exactly.
  [[nodiscard]] std::vector<double> sample(std::size_t k) const;
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] const robot::Path& path() const { return path_; }

 private:
  [[nodiscard]] std::size_t segment_of(double step) const;

  robot::Path path_;
  double rate_;
  Profile profile_;
  std::vector<std::size_t> first_;  ///< sample at each waypoint
  /// For each segment, with a trapezoid: the part of its time for which it accelerates.
  std::vector<double> ramp_;
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

}  // namespace kaboum::motion
