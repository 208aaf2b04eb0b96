#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>

namespace kaboum::geom {

/// Number of planes that hold the surface of a convex polytope: every triangle has its corners
/// within `within` of one of them. An upper bound of the least such number: planes are those of
/// the largest triangles, one after the other, until none is left. Corners that are rounded do
/// not stay in the plane of their facet, so `within` is a few units of what they are rounded to.
/// @pre exactly convex (is_convex)
/// @param within  [length]
std::size_t facet_count(const Mesh& hull, double within);

/// facet_count for corners that were rounded to float32: within eight spacings of float32 at the
/// largest coordinate.
std::size_t float32_facet_count(const Mesh& hull);

}  // namespace kaboum::geom
