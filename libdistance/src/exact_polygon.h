// Planar convex polygons in exact rational arithmetic.
#pragma once

#include <CGAL/Exact_rational.h>
#include <kaboum/geom/mesh.h>

#include <array>
#include <vector>

namespace kaboum::distance::exact {

using Number = CGAL::Exact_rational;
using Point = std::array<Number, 3>;
using Polygon = std::vector<Point>;  ///< convex, planar, in order

inline Point point(const geom::Vec3& p) { return {Number(p.x()), Number(p.y()), Number(p.z())}; }

inline Point difference(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Point cross(const Point& u, const Point& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

inline Number dot(const Point& u, const Point& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

/// Each coordinate is off by one ulp, 2^-52 relatively, at most.
inline geom::Vec3 rounded(const Point& p) {
  return {CGAL::to_double(p[0]), CGAL::to_double(p[1]), CGAL::to_double(p[2])};
}
/// More than that, times the largest |coordinate|, is no rounded point away from its exact one.
constexpr double kRounding = 4e-16;

/// A plane through `point`, not normalised; above is where the normal points.
struct Plane {
  Point point, normal;
};

/// The plane of a triangle with area, its normal outwards.
inline Plane plane_of(const std::array<geom::Vec3, 3>& t) {
  const Point a = point(t[0]);
  return {a, cross(difference(point(t[1]), a), difference(point(t[2]), a))};
}

inline Number height(const Plane& plane, const Point& p) {
  return dot(plane.normal, difference(p, plane.point));
}

/// Cuts a convex polygon; a part without area is left empty.
void split(const Polygon& polygon, const Plane& plane, Polygon& below, Polygon& above);

}  // namespace kaboum::distance::exact
