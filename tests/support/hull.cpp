#include "shapes.h"

#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>

namespace kaboum::test {
namespace {

using geom::Sign;

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  return geom::orient2d(a.x(), a.y(), b.x(), b.y(), c.x(), c.y()) == Sign::Zero &&
         geom::orient2d(a.y(), a.z(), b.y(), b.z(), c.y(), c.z()) == Sign::Zero &&
         geom::orient2d(a.z(), a.x(), b.z(), b.x(), c.z(), c.x()) == Sign::Zero;
}

/// Four points that span space, as a positively oriented tetrahedron.
std::vector<geom::Triangle> first_tetrahedron(const std::vector<Vec3>& p) {
  const auto n = static_cast<std::uint32_t>(p.size());
  std::uint32_t j = 1, k, l;
  while (j < n && p[j] == p[0]) ++j;
  k = j + 1;
  while (k < n && collinear(p[0], p[j], p[k])) ++k;
  l = k + 1;
  while (l < n && geom::orient3d(p[0], p[j], p[k], p[l]) == Sign::Zero) ++l;
  if (l >= n) throw std::invalid_argument("hull of coplanar points");
  std::uint32_t a = 0;
  if (geom::orient3d(p[0], p[j], p[k], p[l]) == Sign::Positive) std::swap(a, j);
  return {{a, j, k}, {j, a, l}, {k, j, l}, {a, k, l}};
}

}  // namespace

Mesh convex_hull(const std::vector<Vec3>& points) {
  std::vector<geom::Triangle> facets = first_tetrahedron(points);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::vector<geom::Triangle> kept;
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> seen;  // directed edges of what goes
    for (const geom::Triangle& f : facets) {
      const Sign s = geom::orient3d(points[f[0]], points[f[1]], points[f[2]], points[i]);
      if (s != Sign::Positive) {
        kept.push_back(f);
        continue;
      }
      for (int k = 0; k < 3; ++k) seen[{f[k], f[(k + 1) % 3]}] = true;
    }
    if (seen.empty()) continue;
    for (const auto& [edge, unused] : seen) {
      if (seen.count({edge.second, edge.first}) != 0) continue;
      kept.push_back({edge.first, edge.second, i});
    }
    facets = std::move(kept);
  }
  Mesh mesh;
  std::map<std::uint32_t, std::uint32_t> index;
  for (const geom::Triangle& f : facets) {
    geom::Triangle t{};
    for (int k = 0; k < 3; ++k) {
      const auto [it, added] = index.emplace(f[k], static_cast<std::uint32_t>(index.size()));
      if (added) mesh.vertices.push_back(points[f[k]]);
      t[k] = it->second;
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

Mesh random_hull(int n, Cloud cloud, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  std::vector<Vec3> points;
  while (points.size() < static_cast<std::size_t>(n)) {
    const double x = uniform(), y = uniform(), z = uniform();
    const Vec3 p(x, y, z);
    const double r = p.norm();
    if (cloud != Cloud::Cube && (r > 1 || r < 0.01)) continue;
    points.push_back(cloud == Cloud::Sphere ? Vec3(p / r) : p);
  }
  return convex_hull(points);
}

}  // namespace kaboum::test
