// Whether a mesh bounds a convex body, exactly.
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>

namespace kaboum::geom {

bool is_convex(const Mesh& hull) {
  if (hull.empty()) return false;
  const TopologyReport topology = analyse(hull);
  if (!topology.closed() || !topology.manifold() || topology.components != 1) return false;
  // Euler's formula: a sphere. With every vertex below every facet it bounds its own hull, once.
  if (topology.vertices + topology.triangles != topology.edges + 2) return false;
  std::vector<char> used(hull.vertices.size(), 0);
  for (const Triangle& t : hull.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  bool solid = false;
  for (const Triangle& t : hull.triangles) {
    const Vec3 &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
    for (std::size_t v = 0; v < hull.vertices.size(); ++v) {
      if (used[v] == 0) continue;
      const Sign side = orient3d(a, b, c, hull.vertices[v]);
      if (side == Sign::Positive) return false;
      solid = solid || side == Sign::Negative;
    }
  }
  return solid;
}

std::optional<std::size_t> find_not_convex(const ConvexSet& set) {
  for (std::size_t i = 0; i < set.bodies.size(); ++i)
    if (!is_convex(set.bodies[i].hull)) return i;
  return std::nullopt;
}

}  // namespace kaboum::geom
