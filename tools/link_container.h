#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/link_body.h>

#include <vector>

namespace kaboum::tools {

/// Polytopes that stand for the bodies of a link, without a margin.
struct LinkContainer {
  geom::ConvexSet set;  ///< float32 vertices; its provenance is left to the caller
  double beyond = 0;    ///< bound of how far they reach beyond what the bodies stand for [length]
};

/// Every polytope contains its body's hull and all that is within the body's margin of it; decided
/// exactly. Bodies of float32 points and no margin are their hulls.
///
/// @pre the points are finite; those of a body without a margin that are float32 are not flat.
LinkContainer link_container(const std::vector<robot::LinkBody>& bodies);

}  // namespace kaboum::tools
