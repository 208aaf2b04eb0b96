#pragma once

#include <kaboum/bcd/cover.h>
#include <kaboum/geom/solid_mesh.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace kaboum::bcd {

/// A closed ball.
struct Ball {
  geom::Vec3 center;
  double radius;
};

/// More balls than these are of no use to planners, and their search would take minutes.
inline constexpr std::size_t kMostBalls = 10'000;

/// Request for find_balls.
struct BallOptions : SearchRun {
  std::optional<std::size_t> max_bodies;
  Effort effort = Effort::Normal;
  /// Within epsilon: once no fewer are found, the same number as near as it was found to allow.
  bool nearest = false;
  /// Within epsilon, more than so many are not searched for.
  std::size_t most = kMostBalls;
  std::vector<geom::Vec3> held;  ///< points of the solid that the balls are to hold as well
  /// Balls of an earlier search with this epsilon: they are moved, and others added, until all is
  /// held, `held` too. Not with max_bodies.
  std::vector<Ball> start;
};

/// Searches for few balls whose union contains the input's solid and every triangle of it. Centres
/// and radii are float32 numbers.
///
/// A ball may be as large as the outer parallel body of the solid at the distance ε allows. Of some
/// hundred large ones few are chosen that hold sampled points, by a local search with weights
/// [gao2015]. Then balls move so that fewer hold them. Points of triangles that no ball holds are
/// added until there are none. With `max_bodies` ε is the least for which so many are found.
/// docs/algorithms/sphere-covers.md.
///
/// No claim that they cover: certify::certify_set decides that. The distances are certified.
///
/// @pre epsilon or max_bodies is given
/// @throws Error{InvalidArgument} on contradictory options; Error{LimitReached} where epsilon takes
///   more balls than options.most, or none were found that hold all
CoverCandidate find_balls(const geom::SolidMesh& input, const BallOptions& options);

/// Balls that somebody has, changed as little as was found to suffice, so that they contain the
/// solid and every triangle of it, none of them reaching farther than epsilon.
///
/// Those that reach farther are made smaller, or put nearer where even their centres are too far.
/// Where points are left out, few balls are made larger; else one near them moves, if it can hold
/// what it alone holds from there; else there is another ball. Of what is changed, centres and
/// radii are float32 numbers.
///
/// No claim that they cover, nor about how far they reach, as for find_balls.
///
/// @param within   of each one given, whether it is known to reach no farther; empty: of none
/// @param options  epsilon is needed; only it, effort, held, most and progress count
/// @return those given, in their order, then the ones added
/// @throws Error{InvalidArgument} without epsilon; Error{LimitReached} where it takes more than
///   options.most, or none were found that hold all
std::vector<Ball> repair_balls(const geom::SolidMesh& input, const std::vector<Ball>& given,
                               const std::vector<bool>& within, const BallOptions& options);

}  // namespace kaboum::bcd
