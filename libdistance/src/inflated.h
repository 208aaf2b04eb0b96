#pragma once

#include <kaboum/geom/convex_set.h>

namespace kaboum::distance {

/// Polytopes inside a set's bodies with their margin.
struct Inflated {
  geom::Mesh mesh;    ///< all facets of all polytopes, side by side
  double defect = 0;  ///< every point of a body with its margin is this near to its polytope
  double excess = 0;  ///< rounding: how far a polytope may stick out
};

/// The hulls of v + margin · q over the vertices v of a body and the points q of a subdivided
/// icosahedron that is inscribed in the unit sphere, and of each facet moved out by the margin.
/// Pairs v, q that cannot matter are left out. docs/algorithms/distances.md, "Margins".
///
/// @param level  of subdivision, 0 to 6: the defect is some 0.2 · margin / 4^level.
/// @pre set.margin > 0; bodies convex.
Inflated inflate(const geom::ConvexSet& set, int level);

}  // namespace kaboum::distance
