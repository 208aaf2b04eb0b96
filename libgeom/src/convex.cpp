// Convex bodies and sets of them: whether they are convex, exactly; radii and boxes.
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <cmath>

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

bool is_convex(const ConvexBody& body) {
  if (!(body.radius >= 0) || !std::isfinite(body.radius)) return false;
  if (!body.core.triangles.empty()) return is_convex(body.core);
  const std::vector<Vec3>& points = body.core.vertices;
  if (points.empty() || points.size() > 2 || body.radius == 0) return false;
  if (!std::ranges::all_of(points, [](const Vec3& p) { return p.allFinite(); })) return false;
  return points.size() == 1 || points[0] != points[1];
}

std::optional<std::size_t> find_not_convex(const ConvexSet& set) {
  for (std::size_t i = 0; i < set.bodies.size(); ++i)
    if (!is_convex(set.bodies[i])) return i;
  return std::nullopt;
}

std::optional<double> margin_of(const ConvexSet& set) {
  if (set.bodies.empty()) return 0;
  const double radius = set.bodies.front().radius;
  const bool one = std::ranges::all_of(set.bodies, [&](const ConvexBody& body) {
    return body.radius == radius && !body.core.triangles.empty();
  });
  return one ? std::optional(radius) : std::nullopt;
}

void set_margin(ConvexSet& set, double radius) {
  for (ConvexBody& body : set.bodies) body.radius = radius;
}

Box3 bounding_box(const ConvexBody& body) {
  Box3 box = bounding_box(body.core);
  if (body.core.triangles.empty())
    for (const Vec3& p : body.core.vertices) box.extend(p);
  if (body.radius > 0 && !box.empty()) {
    const Vec3 reach =
        Vec3::Constant(body.radius) +
        0x1p-51 * (box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()) + Vec3::Constant(body.radius));
    box.min -= reach;
    box.max += reach;
  }
  return box;
}

}  // namespace kaboum::geom
