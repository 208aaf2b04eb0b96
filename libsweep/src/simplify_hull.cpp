// Leaves vertices of a hull out while those that stay are near enough to them.
// docs/algorithms/swept-volumes.md.

#include "simplify_hull.h"

#include <kaboum/geom/point_triangle.h>

#include <algorithm>

namespace kaboum::sweep {

double simplify_hull(std::vector<Vec3>& vertices, double allowed, geom::HullBuilder& builder) {
  if (!(allowed > 0) || vertices.size() <= 4) return 0;
  std::vector<char> stays(vertices.size(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto less = [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; };
    const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(), less);
    stays[static_cast<std::size_t>(low - vertices.begin())] = 1;
    stays[static_cast<std::size_t>(high - vertices.begin())] = 1;
  }
  std::vector<Vec3> chosen;
  for (;;) {
    chosen.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (stays[i] != 0) chosen.push_back(vertices[i]);
    if (!builder.build(chosen)) return 0;
    // Vertices of the whole hull are never strictly inside that of some, so facets are the nearest.
    double farthest = 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (stays[i] != 0) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (const geom::Triangle& t : builder.triangles()) {
        nearest = std::min(nearest, geom::point_triangle_upper(vertices[i], chosen[t[0]],
                                                               chosen[t[1]], chosen[t[2]]));
        if (nearest <= farthest) break;
      }
      if (nearest <= farthest) continue;
      farthest = nearest;
      next = i;
    }
    if (farthest <= allowed) {
      vertices = std::move(chosen);
      return farthest;
    }
    stays[next] = 1;
  }
}

}  // namespace kaboum::sweep
