#pragma once

#include <kaboum/geom/convex_set.h>

namespace kaboum::distance {

/// Polytopes inside the bodies of a set.
struct Inflated {
  geom::ConvexSet polytopes;  ///< one for each body
  double defect = 0;          ///< every point of a body is this near to its polytope
  double excess = 0;          ///< rounding: how far a polytope may stick out
};

/// Polytopes inside the bodies (geom::inscribed_polytope). docs/algorithms/distances.md, "Margins".
///
/// @param level  of subdivision, 0 to 6: the defect is some 0.2 · radius / 4^level.
/// @pre bodies convex.
Inflated inflate(const geom::ConvexSet& set, int level);

}  // namespace kaboum::distance
