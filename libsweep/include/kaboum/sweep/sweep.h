#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/link_body.h>
#include <kaboum/sweep/steps.h>

#include <functional>
#include <string>

namespace kaboum::sweep {

using robot::LinkBody;

struct SweepOptions {
  double epsilon = 0;  ///< largest margin of the result, > 0 [length]
  /// Share of epsilon, 0 to 0.9, by which vertices of the hulls may be left out: fewer vertices,
  /// more bodies.
  double simplify = 0;
  StepRule rule = StepRule::Balanced;
  bool merge = true;
  std::optional<double> max_excess;  ///< see StepOptions
  /// Polytopes that contain the sum with the ball of radius `margin`, which then is 0.
  bool explicit_margin = false;
  /// Is told now and then what is done, in the calling thread; what it throws ends the work.
  std::function<void(const std::string& stage)> progress = {};
};

enum class Stop {
  Done,
  TooCoarse,  ///< float32's spacing at the robot's reach exceeds epsilon/100: nothing was made
};

struct SweepResult {
  geom::ConvexSet set;  ///< provenance is left to the caller
  Stop stop = Stop::Done;
  bool certified = true;             ///< false for StepRule::Baginski
  double deviation = 0;              ///< largest of a piece, the bodies' margins included [length]
  double left_out = 0;               ///< largest distance of a vertex left out [length]
  double rounding = 0;               ///< largest move of a vertex to float32 [length]
  double excess = 0;                 ///< bound of the distance from a point of the set to the
                                     ///< swept volume of the bodies [length]
  std::vector<std::size_t> of_link;  ///< bodies made, per link of the robot
  std::vector<PathInterval> pieces;  ///< of every body in the set
  std::vector<std::size_t> sources;  ///< index of the LinkBody that each body of the set sweeps
};

/// Convex bodies that, enlarged by the set's margin, contain the bodies at every configuration of
/// the path. Source: [gaschler2016] Eq. 4.22, Prop. 3; docs/algorithms/swept-volumes.md.
///
/// Each is the exactly convex float32 hull of a body's images at the ends of a piece; the margin
/// covers the steps' deviation, the error of kinematics, the rounding and vertices left out, and is
/// at most epsilon. The same for any number of threads. Order: by body, then along the path.
///
/// @throws Error{InvalidArgument} on contradictory options, bodies without points, and margins that
///   leave no room for steps; as choose_steps.
SweepResult swept_volume(const Robot& robot, std::span<const LinkBody> bodies, const Path& path,
                         const SweepOptions& options);

/// Points whose hull contains every ball of the radius round the points (which need not be
/// convex). Each ball is replaced by an icosahedron: 1.26 times the radius at most.
std::vector<Vec3> enlarge(std::span<const Vec3> points, double radius);

}  // namespace kaboum::sweep
