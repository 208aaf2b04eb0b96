#pragma once

#include <kaboum/verify/inclusion.h>

namespace kaboum::verify {

/// The answer to a distance claim.
struct DistanceClaim {
  Answer answer = Answer::Undefined;
  std::string reason;
  double largest = 0;  ///< a distance that is certainly reached somewhere, at `at` [length]
  geom::Vec3 at = geom::Vec3::Zero();
  std::uint32_t triangle = 0;  ///< of `from`, the one that `at` lies on
  std::size_t pieces = 0;      ///< parts of triangles, or of bodies, looked at
};

struct DistanceClaimOptions {
  /// Points with w_to ≥ 1 have distance 0. @pre `to` is a closed chain
  bool to_solid = false;
  std::size_t max_pieces_of_one = std::size_t{1} << 18U;  ///< of one triangle
  std::size_t max_pieces = 500'000'000;  ///< of all of them, up to a few thousand triangles more
};

/// Decides whether every point of the triangles of `from` is within `epsilon` of the triangles of
/// `to`, or of its solid.
///
/// A part of a triangle passes when its corners are within ε of one triangle of `to` (the distance
/// to a convex set is convex), or when it lies inside the solid as a whole. It fails when a corner
/// is certainly farther away. Otherwise it is cut, along the prism of the nearest triangle where
/// that is possible. Upper bounds are distances to convex combinations of corners, lower bounds
/// distances to separating planes, both widened by their rounding:
/// docs/algorithms/exact-inclusion.md, "Distance". Suprema closer to ε than the rounding stay
/// undecided.
///
/// Triangles of `to` without area are passed over; those of `from` count. Undefined if none of `to`
/// has an area.
///
/// @pre epsilon > 0
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite, or that
///   span more than 10^300 between them.
DistanceClaim verify_distance(const geom::Mesh& from, const geom::Mesh& to, double epsilon,
                              const DistanceClaimOptions& options = {});

}  // namespace kaboum::verify
