#pragma once

#include <kaboum/geom/convex_hull.h>

namespace kaboum::sweep {

using geom::Vec3;

/// Leaves as few of a hull's vertices as keep the others within `allowed` of the new hull: the
/// farthest is taken in until all are near enough. Flat sets stay as they are.
/// @param vertices  of a convex hull, each extreme; replaced by those that stay, in their order.
/// @return the largest distance of one left out from the new hull, rounded up; at most `allowed`.
double simplify_hull(std::vector<Vec3>& vertices, double allowed, geom::HullBuilder& builder);

}  // namespace kaboum::sweep
