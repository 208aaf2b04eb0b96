#pragma once

#include <kaboum/robot/path.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace kaboum::motion {

/// Waypoints in time with derivatives, as controllers take them: between two of them each joint
/// follows the cubic polynomial by values and velocities or, with accelerations, the one of degree
/// 5.
struct SplineWaypoints {
  std::vector<double> times;  ///< growing [s]
  robot::Path positions, velocities;
  robot::Path accelerations = {};  ///< empty: cubic polynomials
};

/// Straight lines near polynomials between waypoints.
struct SplineLines {
  robot::Path points;  ///< of the polynomials, but for rounding; the waypoints are among them
  /// How far each variable is from the straight line at most, at the same share of the time between
  /// two points (docs/algorithms/motion-planning.md#polynomials-between-waypoints). [rad or length]
  std::vector<double> around;
  std::vector<std::size_t> waypoints;  ///< where each waypoint is among the points

  /// The waypoint before a place on the lines, and the share of the time to the next one.
  /// @param line  from point `line` to the next one; the last point is at share 0 as well
  [[nodiscard]] std::pair<std::size_t, double> place(std::size_t line, double share) const;
};

/// Number of lines between each waypoint and the next one such that no variable is farther from
/// them than `within`, rounding apart.
/// @param within  > 0 [rad or length]
/// @throws Error{InvalidInput} naming waypoints at the same time, and numbers that are too large;
///   Error{LimitReached} where there would be more than 5,000,000 lines
std::vector<std::size_t> spline_parts(const SplineWaypoints& spline, double within);

/// @param parts  lines between each waypoint and the next one, ≥ 1
/// @throws as spline_parts
SplineLines spline_lines(const SplineWaypoints& spline, std::span<const std::size_t> parts);

}  // namespace kaboum::motion
