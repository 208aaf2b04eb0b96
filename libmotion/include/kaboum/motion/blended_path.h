#pragma once

#include <kaboum/robot/path.h>

#include <optional>
#include <vector>

namespace kaboum::motion {

/// Point of a curve, and the curve's derivatives by its parameter.
struct CurvePoint {
  std::vector<double> q, first, second;
};

/// Part of a blended path: straight, or the blend of a corner.
///
/// Its points are from + s·in + s²/(2·length)·(out − in): of a blend, those of a parabola.
struct PathPiece {
  std::size_t waypoint = 0;  ///< where its segment begins, or that is its corner
  bool is_blend = false;
  double length = 0;              ///< of its parameter, > 0
  std::vector<double> from;       ///< point at 0
  std::vector<double> in, out;    ///< derivatives at 0 and at `length`; of a straight piece alike
  std::vector<double> low, high;  ///< of the values of the waypoints that it lies between

  /// @pre 0 ≤ s ≤ length
  [[nodiscard]] CurvePoint at(double s) const;
};

/// The largest share of a segment that a blend may take.
inline constexpr double kMostBlend = 0.95;

/// A polyline of which corners are replaced by parabolas: continuously differentiable between its
/// stops. Each blend is inside the triangle of its ends and the corner
/// (docs/algorithms/motion-planning.md#blended-corners).
///
/// Behind a stop the parameter of a segment grows by the largest |Δqⱼ| / vⱼ of a joint: where it
/// grows by 1 a second, the fastest joint of a segment is at its limit vⱼ. Limits above 1e9 count
/// as that here. Behind a blend it is another one, so that derivatives are continuous.
class BlendedPath {
 public:
  /// @param shares  for each waypoint, 0 to kMostBlend: the blend takes at most this share of each
  /// of
  ///   the two segments, and at most a half of one at the other end of which there is a blend as
  ///   well; of one of them no more than half as much again as of the other. Below 1e-6 the path
  ///   stops there. Those of first and last waypoint, and of waypoints that are the same as the one
  ///   before, to 1e-14, are not looked at. Where a path turns back, by more than 179° in the
  ///   velocities' units, it stops as well.
  /// @param velocity  > 0, of each variable
  /// @throws Error{InvalidArgument} for shares that are none, or as many as there are no waypoints.
  BlendedPath(const robot::Path& path, const std::vector<double>& shares,
              const std::vector<double>& velocity);

  [[nodiscard]] const std::vector<PathPiece>& pieces() const { return pieces_; }
  /// Number of pieces before each stop: first 0, last all of them.
  [[nodiscard]] const std::vector<std::size_t>& stops() const { return stops_; }
  /// The waypoints at which it stops, as many as stops(): the first, the last, corners without a
  /// blend.
  [[nodiscard]] const std::vector<std::size_t>& stopping_waypoints() const { return at_; }

 private:
  std::vector<PathPiece> pieces_;
  std::vector<std::size_t> stops_, at_;
};

/// True if a path turns back at a waypoint so sharply that it has to stop there.
bool turns_back(const std::vector<double>& before, const std::vector<double>& corner,
                const std::vector<double>& after, const std::vector<double>& velocity);

}  // namespace kaboum::motion
