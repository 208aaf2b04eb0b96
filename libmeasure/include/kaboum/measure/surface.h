#pragma once

#include <kaboum/geom/convex_set.h>

namespace kaboum::measure {

/// The boundary of a union of convex bodies, as a surface.
struct UnionBoundary {
  geom::Mesh mesh;  ///< the parts of the facets that bound the union, triangulated
  double error =
      0;  ///< every point of either surface is within this distance of the other [length]
};

/// Clips every facet against all other bodies; what lies inside them, or between two bodies that
/// touch there, is left out. Margins are not looked at.
///
/// Cuts are made in exact rational arithmetic and their corners rounded once; `error` bounds what
/// that moves (docs/algorithms/distances.md, "Convex sets").
///
/// @throws Error{InvalidInput} naming a body that is not convex.
UnionBoundary union_boundary(const geom::ConvexSet& set);

}  // namespace kaboum::measure
