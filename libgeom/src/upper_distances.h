#pragma once

#include <kaboum/geom/mesh.h>

#include <span>

namespace kaboum::geom {

/// Upper bounds of the distances of points from the closed triangle (a, b, c), four at once: above
/// those of point_triangle_upper by roundings at most, but for slivers.
///
/// @param out  of as many as there are points
/// @pre as of point_triangle_distance.
void upper_distances(std::span<const Vec3> points, const Vec3& a, const Vec3& b, const Vec3& c,
                     double* out);

}  // namespace kaboum::geom
