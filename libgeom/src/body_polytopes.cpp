// Polytopes inside and round convex bodies. docs/algorithms/rounded-bodies.md.
#include <kaboum/base/error.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace kaboum::geom {
namespace {

/// The core without vertices that no facet uses.
Mesh bare(const Mesh& core) { return core.triangles.empty() ? core : weld(core); }

/// v + radius · q for the vertices of the core and the points of the sphere.
std::vector<Vec3> sums(const Mesh& core, double radius, const SpherePoints& sphere) {
  Box3 box;
  for (const Vec3& v : core.vertices) box.extend(v);
  // A vertex that is extreme in some direction is this near to being so in that of a point of the
  // sphere, too; the second part covers rounding.
  const double near =
      box.diagonal() * std::sqrt(2 - 2 * sphere.inner) * (1 + 1e-9) +
      kDistanceRounding * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  std::vector<Vec3> points;
  for (const Vec3& q : sphere.points) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : core.vertices) highest = std::max(highest, q.dot(v));
    for (const Vec3& v : core.vertices)
      if (q.dot(v) >= highest - near) points.emplace_back(v + radius * q);
  }
  return points;
}

}  // namespace

SpherePoints sphere_points(int level) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vec3> p;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g}) p.insert(p.end(), {{0, a, b}, {a, b, 0}, {b, 0, a}});
  for (Vec3& v : p) v *= (1 - 1e-15) / v.norm();
  std::vector<Triangle> faces = convex_hull(p)->triangles;
  for (int l = 0; l < level; ++l) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] =
          middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(p.size()));
      if (fresh) {
        const Vec3 v = p[a] + p[b];
        p.emplace_back((1 - 1e-15) / v.norm() * v);
      }
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : faces) {
      const std::uint32_t x = between(a, b), y = between(b, c), z = between(c, a);
      finer.insert(finer.end(), {{a, x, z}, {x, b, y}, {z, y, c}, {x, y, z}});
    }
    faces = std::move(finer);
  }
  SpherePoints sphere{std::move(p), 1};
  const std::vector<Vec3>& q = sphere.points;
  for (const auto& [a, b, c] : faces) {
    const Vec3 n = (q[b] - q[a]).cross(q[c] - q[a]).normalized();
    sphere.inner = std::min(sphere.inner, std::abs(n.dot(q[a])));
  }
  sphere.inner -= 1e-12;  // rounding of the normals
  return sphere;
}

Mesh inscribed_polytope(const ConvexBody& body, const SpherePoints& sphere) {
  if (body.radius == 0) return body.core;
  const Mesh core = bare(body.core);
  std::vector<Vec3> points = sums(core, body.radius, sphere);
  for (const auto& [a, b, c] : core.triangles) {
    const Vec3 n = (core.vertices[b] - core.vertices[a]).cross(core.vertices[c] - core.vertices[a]);
    if (!(n.norm() > 0)) continue;
    for (const std::uint32_t v : {a, b, c})
      points.emplace_back(core.vertices[v] + body.radius * (1 - 1e-15) / n.norm() * n);
  }
  return convex_hull(points).value_or(Mesh{});
}

Mesh circumscribed_polytope(const ConvexBody& body, const SpherePoints& sphere) {
  if (body.radius == 0) return body.core;
  const Mesh core = bare(body.core);
  double largest = body.radius;
  for (const Vec3& v : core.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  const double radius = body.radius / sphere.inner * (1 + 1e-9) + 0x1p-48 * largest;
  auto polytope = convex_hull(sums(core, radius, sphere));
  ensure(polytope.has_value(), "the hull of a body and a ball has volume");
  return *std::move(polytope);
}

Mesh surface_of(const ConvexBody& body) {
  constexpr int kLevel = 2;
  return body.radius == 0 ? body.core : circumscribed_polytope(body, sphere_points(kLevel));
}

}  // namespace kaboum::geom
