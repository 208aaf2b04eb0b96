#pragma once

#include <kaboum/geom/convex_set.h>

#include <vector>

namespace kaboum::tools {

/// A PNG of the set, one colour per body; with explode > 0 a second panel shows the bodies moved
/// away from the set's middle by that share of their distance from it.
std::vector<char> picture_of(const geom::ConvexSet& set, double explode);

}  // namespace kaboum::tools
