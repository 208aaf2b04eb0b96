#pragma once

#include <kaboum/geom/interior.h>
#include <kaboum/geom/triangle_search.h>

#include <cstddef>
#include <cstdint>

namespace kaboum::geom {

/// One-sided Hausdorff distance sup_{x∈A} d(x, B) between surfaces. [length]
struct DirectedDistance {
  double max_lower = 0;  ///< certified bracket of the supremum
  double max_upper = 0;
  Vec3 at = Vec3::Zero();  ///< point of A, within rounding, whose distance is at least max_lower
  bool within_gap = true;  ///< false: the gap was not reached in the work allowed (max_pieces at a
                           ///< time), or coordinates are too large for it (see below)
  std::uint64_t queries = 0;
};

struct DistanceOptions {
  double relative_gap = 1e-3;  ///< stop when upper ≤ lower · (1 + relative_gap) …
  double absolute_gap = 1e-9;  ///< … or upper ≤ lower + absolute_gap · diagonal of A and B's box
                               ///< (much smaller ones are reached slowly, if at all)
  double offset = 0;  ///< the gap is wanted for max(0, distance − offset); the bracket returned is
                      ///< that of the distance itself [length]
  std::size_t max_pieces = std::size_t{1} << 23;  ///< at a time, of some 400 bytes each

  /// The largest upper bound that meets the wish, given a lower bound. @param diagonal of the box.
  [[nodiscard]] double wished(double lower, double diagonal) const {
    const double beyond = lower > offset ? lower - offset : 0;
    const double wide = beyond * (1 + relative_gap), least = beyond + absolute_gap * diagonal;
    return offset + (wide > least ? wide : least);
  }
};

/// Branch and bound over convex pieces of A's triangles.
///
/// Upper bound of a piece: d(·, t) is convex for one triangle t of B, so its largest value over the
/// piece is at a corner; t is the triangle nearest to the piece's centroid, or to its worst corner.
/// A piece that is not settled is cut along the prism of t, so that coplanar surfaces fall apart
/// into the cells in which one triangle of B is nearest, instead of being halved down to the gap.
/// Rounds are evaluated in parallel (oneTBB); the result does not depend on the number of threads.
///
/// Corners made by cuts and centroids are rounded; the bracket allows for that, some 1e-14 times
/// the largest |coordinate| of A. Translate meshes far from the origin first, where that is exact.
///
/// @pre A and B have triangles and finite coordinates; B is given as a query.
/// @param inside  when not null, the distance of points of A to the solid that B bounds: 0 inside.
/// @throws Error{InvalidInput} when A has no triangles.
DirectedDistance directed_distance(const Mesh& a, const TriangleSearch& b,
                                   const DistanceOptions& options = {},
                                   const Interior* inside = nullptr);

/// The same for A's triangles as its own search structure holds them; faster where that exists.
DirectedDistance directed_distance(const TriangleSearch& a, const TriangleSearch& b,
                                   const DistanceOptions& options = {},
                                   const Interior* inside = nullptr);

}  // namespace kaboum::geom
