#pragma once

#include <kaboum/geom/mesh.h>

#include <array>

namespace kaboum::geom {

/// Certified bracket of a distance: lower ≤ true distance ≤ upper, in spite of rounding. [length]
struct DistanceBounds {
  double lower;
  double upper;
};

/// Distance of point p to the closed triangle (a, b, c), which may be degenerate.
///
/// The closest point is computed in rounded arithmetic; the bounds hold however badly that went.
/// `upper` is the distance to a convex combination of the corners, `lower` the distance to a plane
/// that separates p from the corners, both widened by the rounding error derived in
/// docs/algorithms/distances.md.
///
/// @pre coordinates of magnitude below 1e70; differences that matter above 1e-70.
DistanceBounds point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// True if the triangle's box, and so the triangle, is certainly farther from p than `radius`.
bool box_beyond(const Vec3& p, const std::array<Vec3, 3>& t, double radius);

/// The upper bound alone, cheaper: never below the distance, and above point_triangle_distance's
/// bound by rounding at most.
double point_triangle_upper(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// The point of the triangle (a, b, c) nearest to p, rounded; for reports.
Vec3 nearest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace kaboum::geom
