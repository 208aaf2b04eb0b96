// Boxes, cylinders, spheres, capsules and ellipsoids as points whose hull contains them.

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/robot.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model_words.h"

namespace kaboum::robot {
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

/// Spheres round both ends of its segment.
std::vector<Vec3> capsule(double radius, double length) {
  std::vector<Vec3> points;
  for (const Vec3& p : sphere(radius))
    for (const double end : {-0.5, 0.5}) points.emplace_back(p + Vec3(0, 0, end * length));
  return points;
}

}  // namespace

Vec3 solid_size(const Geometry& geometry) {
  const double least = 0.005 * geometry.size.maxCoeff();
  return (geometry.size.array() == 0).select(least, geometry.size);
}

bool is_flat(const Geometry& g) {
  return g.shape != Geometry::Shape::Mesh && (g.size.array() == 0).any();
}

bool is_point(const Geometry& g) {
  return g.shape != Geometry::Shape::Mesh && (g.size.array() == 0).all();
}

std::string describe(const Geometry& g) {
  const auto nothing = [&](const char* name, double x, const char* other, double y) {
    std::string text = name;
    if (x == 0) text += other;
    return y == 0 ? text + (x == 0 ? " and length 0" : " of length 0") : text;
  };
  switch (g.shape) {
    case Geometry::Shape::Mesh:
      return "mesh";
    case Geometry::Shape::Box: {
      const auto sides = (g.size.array() == 0).count();
      return sides == 0 ? "box" : "box with " + std::to_string(sides) + " of 3 sides 0";
    }
    case Geometry::Shape::Cylinder:
      return nothing("cylinder", g.size.x(), " of radius 0", g.size.y());
    case Geometry::Shape::Capsule:
      return nothing("capsule", g.size.x(), " of radius 0", g.size.y());
    case Geometry::Shape::Ellipsoid:
      return is_flat(g) ? "ellipsoid with an axis of 0" : "ellipsoid";
    case Geometry::Shape::Sphere:
      break;
  }
  return g.size.x() == 0 ? "sphere of radius 0" : "sphere";
}

double bounding_excess(const Geometry& g) {
  if (g.shape == Geometry::Shape::Mesh) return 0;
  const Vec3 size = solid_size(g);
  const double added = (size - g.size).norm();
  if (g.shape == Geometry::Shape::Sphere) return 0.02 * size.x();
  if (g.shape == Geometry::Shape::Capsule) return 0.02 * size.x() + added;
  if (g.shape == Geometry::Shape::Ellipsoid) return 0.02 * size.maxCoeff() + added;
  if (g.shape == Geometry::Shape::Cylinder) return 0.005 * size.x() + added;
  return added;
}

std::vector<Vec3> bounding_points(const Geometry& g) {
  if (is_point(g)) throw Error(ErrorCode::InvalidArgument, "a point is not bounded by a polytope");
  std::vector<Vec3> points;
  const Vec3 size = solid_size(g);
  switch (g.shape) {
    case Geometry::Shape::Box:
      points = box(size);
      break;
    case Geometry::Shape::Cylinder:
      points = cylinder(size.x(), size.y());
      break;
    case Geometry::Shape::Sphere:
      points = sphere(size.x());
      break;
    case Geometry::Shape::Capsule:
      points = capsule(size.x(), size.y());
      break;
    case Geometry::Shape::Ellipsoid:
      points = sphere(1);
      for (Vec3& p : points) p = p.cwiseProduct(size);
      break;
    case Geometry::Shape::Mesh:
      throw Error(ErrorCode::InvalidArgument, "a mesh is not bounded by a formula");
  }
  for (Vec3& p : points) p = g.origin * p;
  return points;
}

}  // namespace kaboum::robot
