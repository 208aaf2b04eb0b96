#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace kaboum::examples {

/// A point of the plane on an integer grid; magnitudes below 2^24 keep all predicates exact.
struct GridPoint {
  std::int64_t x, y;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

using Loop = std::vector<GridPoint>;

struct PlanarMesh {
  std::vector<GridPoint> points;  ///< the loops' points in order, then the points added inside
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise
};

/// Triangulates a polygon with holes, with further points inside at about the given spacing.
///
/// A Delaunay triangulation (Bowyer 1981, Watson 1981) in which the loops' edges are then enforced
/// by flips (Sloan 1993). All decisions are exact integer arithmetic, so it cannot fail on
/// collinear or cocircular points.
///
/// @param loops    simple, disjoint, no repeated points; the outer one counter-clockwise, holes
///                 clockwise: the region lies to the left of every edge. Edges are not subdivided.
/// @param spacing  grid units; points are added where they are at least 0.6 spacings from the
/// loops.
/// @throws Error{Internal} when the loops cross themselves or each other.
PlanarMesh triangulate(const std::vector<Loop>& loops, double spacing);

}  // namespace kaboum::examples
