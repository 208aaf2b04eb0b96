#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/error.h>
#include <kaboum/sweep/robot.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kaboum::sweep {
namespace {

constexpr double kUp = 1 + 1e-12;

std::vector<Vec3> box(const Vec3& size) {
  std::vector<Vec3> out;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5}) out.emplace_back(x * size.x(), y * size.y(), z * size.z());
  return out;
}

/// The sides touch the cylinder in their middles.
std::vector<Vec3> cylinder(double radius, double length) {
  constexpr int kSides = 32;
  const double r = radius / std::cos(std::numbers::pi / kSides) * kUp;
  std::vector<Vec3> out;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    for (const double z : {-0.5, 0.5})
      out.emplace_back(r * std::cos(angle), r * std::sin(angle), z * length);
  }
  return out;
}

/// Corners of an icosahedron whose edges are split in four, on the unit sphere.
std::vector<Vec3> unit_sphere() {
  std::vector<Vec3> points;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-std::numbers::phi, std::numbers::phi}) {
      points.emplace_back(Vec3(0, a, b).normalized());
      points.emplace_back(Vec3(a, b, 0).normalized());
      points.emplace_back(Vec3(b, 0, a).normalized());
    }
  }
  for (int split = 0; split < 2; ++split) {
    const auto hull = geom::convex_hull(points);
    ensure(hull.has_value(), "the icosahedron has no hull");
    for (const geom::Triangle& t : hull->triangles)
      for (int k = 0; k < 3; ++k)
        if (t[k] < t[(k + 1) % 3])
          points.emplace_back((hull->vertices[t[k]] + hull->vertices[t[(k + 1) % 3]]).normalized());
  }
  return points;
}

/// Scaled until its facets are outside the ball.
std::vector<Vec3> sphere(double radius) {
  std::vector<Vec3> points = unit_sphere();
  const auto hull = geom::convex_hull(points);
  ensure(hull.has_value(), "the sphere has no hull");
  double nearest = 1;
  for (const geom::Triangle& t : hull->triangles) {
    const Vec3 &a = hull->vertices[t[0]], &b = hull->vertices[t[1]], &c = hull->vertices[t[2]];
    nearest = std::min(nearest, (b - a).cross(c - a).normalized().dot(a));
  }
  for (Vec3& p : points) p *= radius / nearest * kUp;
  return points;
}

}  // namespace

double bounding_excess(const Geometry& g) {
  if (g.shape == Geometry::Shape::Sphere) return 0.02 * g.size.x();
  if (g.shape == Geometry::Shape::Cylinder) return 0.005 * g.size.x();
  return 0;
}

std::vector<Vec3> bounding_points(const Geometry& g) {
  std::vector<Vec3> points;
  switch (g.shape) {
    case Geometry::Shape::Box:
      points = box(g.size);
      break;
    case Geometry::Shape::Cylinder:
      points = cylinder(g.size.x(), g.size.y());
      break;
    case Geometry::Shape::Sphere:
      points = sphere(g.size.x());
      break;
    case Geometry::Shape::Mesh:
      throw Error(ErrorCode::InvalidArgument, "a mesh is not bounded by a formula");
  }
  for (Vec3& p : points) p = g.origin * p;
  return points;
}

}  // namespace kaboum::sweep
