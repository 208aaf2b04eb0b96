#pragma once

#include <kaboum/geom/mesh.h>

#include <span>

namespace kaboum::geom {

/// True only if all points are within `radius` of the closed triangle (a, b, c): so it is, up to a
/// few roundings, where point_triangle_upper says so of each, but for slivers. Four points at once.
///
/// @pre as of point_triangle_distance; a radius below 1e70.
bool all_within(std::span<const Vec3> points, const Vec3& a, const Vec3& b, const Vec3& c,
                double radius);

}  // namespace kaboum::geom
