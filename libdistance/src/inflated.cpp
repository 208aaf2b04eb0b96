// Convex bodies enlarged by a margin, as polytopes within them. docs/algorithms/distances.md,
// "Convex sets".
#include "inflated.h"

#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace kaboum::distance {
namespace {

using geom::Mesh;
using geom::Triangle;
using geom::Vec3;

/// Points of the unit sphere, of length 1 at most.
struct Sphere {
  std::vector<Vec3> points;
  double inner = 1;  ///< their hull contains the ball of this radius
};

Sphere icosphere(int level) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vec3> p;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g}) p.insert(p.end(), {{0, a, b}, {a, b, 0}, {b, 0, a}});
  for (Vec3& v : p) v *= (1 - 1e-15) / v.norm();
  std::vector<Triangle> faces = geom::convex_hull(p)->triangles;
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
  Sphere sphere{std::move(p), 1};
  const std::vector<Vec3>& q = sphere.points;
  for (const auto& [a, b, c] : faces) {
    const Vec3 n = (q[b] - q[a]).cross(q[c] - q[a]).normalized();
    sphere.inner = std::min(sphere.inner, std::abs(n.dot(q[a])));
  }
  sphere.inner -= 1e-12;  // rounding of the normals
  return sphere;
}

/// The polytope of one body.
Mesh inflated(const Mesh& hull, double margin, const Sphere& sphere) {
  const Mesh body = geom::weld(hull);  // without vertices that no facet uses
  const geom::Box3 box = geom::bounding_box(body);
  // A vertex that is extreme in some direction is this near to being so in that of a point of the
  // sphere, too; the second part covers rounding.
  const double near =
      box.diagonal() * std::sqrt(2 - 2 * sphere.inner) * (1 + 1e-9) +
      geom::kDistanceRounding * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  std::vector<Vec3> points;
  for (const Vec3& q : sphere.points) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : body.vertices) highest = std::max(highest, q.dot(v));
    for (const Vec3& v : body.vertices)
      if (q.dot(v) >= highest - near) points.emplace_back(v + margin * q);
  }
  for (const auto& [a, b, c] : body.triangles) {
    const Vec3 n = (body.vertices[b] - body.vertices[a]).cross(body.vertices[c] - body.vertices[a]);
    if (!(n.norm() > 0)) continue;
    for (const std::uint32_t v : {a, b, c})
      points.emplace_back(body.vertices[v] + margin * (1 - 1e-15) / n.norm() * n);
  }
  const auto polytope = geom::convex_hull(points);
  ensure(polytope.has_value(), "the hull of a body and a ball has volume");
  return *polytope;
}

}  // namespace

Inflated inflate(const geom::ConvexSet& set, int level) {
  const Sphere sphere = icosphere(level);
  std::vector<Mesh> polytopes(set.bodies.size());
  parallel_for(std::size_t{0}, polytopes.size(), [&](std::size_t i) {
    polytopes[i] = inflated(set.bodies[i].hull, set.margin, sphere);
  });
  Inflated out;
  double largest = 0;
  for (const Mesh& polytope : polytopes) {
    const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
    for (const Vec3& v : polytope.vertices) {
      out.mesh.vertices.push_back(v);
      largest = std::max(largest, v.cwiseAbs().maxCoeff());
    }
    for (const auto& [a, b, c] : polytope.triangles)
      out.mesh.triangles.push_back({first + a, first + b, first + c});
  }
  // Sums of a coordinate and at most the margin, rounded.
  out.excess = 1e-15 * (largest + set.margin);
  out.defect = set.margin * (1 - sphere.inner) + out.excess;
  return out;
}

}  // namespace kaboum::distance
