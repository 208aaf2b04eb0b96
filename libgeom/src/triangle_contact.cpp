// How two triangles, or a segment and a triangle, meet; exact.
#include "triangle_contact.h"

#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <vector>

namespace kaboum::geom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

bool meet_improperly(const Mesh& mesh, std::uint32_t t, std::uint32_t u) {
  const Triangle &x = mesh.triangles[t], &y = mesh.triangles[u];
  const auto at = [&](std::uint32_t v) -> const Vec3& { return mesh.vertices[v]; };
  const auto beside = [&](const Triangle& plane, const Triangle& other) {
    bool above = true, below = true;
    for (const std::uint32_t v : other) {
      const Sign s = orient3d(at(plane[0]), at(plane[1]), at(plane[2]), at(v));
      above = above && s == Sign::Positive;
      below = below && s == Sign::Negative;
    }
    return above || below;
  };
  if (beside(x, y) || beside(y, x)) return false;
  if (is_degenerate(at(x[0]), at(x[1]), at(x[2])) || is_degenerate(at(y[0]), at(y[1]), at(y[2])))
    return false;
  std::vector<std::uint32_t> common, rest_x, rest_y;
  for (const std::uint32_t v : x)
    (std::find(y.begin(), y.end(), v) != y.end() ? common : rest_x).push_back(v);
  for (const std::uint32_t v : y)
    if (std::find(x.begin(), x.end(), v) == x.end()) rest_y.push_back(v);
  const auto triangle = [&](const Triangle& c) {
    return Kernel::Triangle_3(point(at(c[0])), point(at(c[1])), point(at(c[2])));
  };
  const auto segment = [&](const std::vector<std::uint32_t>& c) {
    return Kernel::Segment_3(point(at(c[0])), point(at(c[1])));
  };
  switch (common.size()) {
    case 0:
      return CGAL::do_intersect(triangle(x), triangle(y));
    case 1:
      return CGAL::do_intersect(triangle(x), segment(rest_y)) ||
             CGAL::do_intersect(triangle(y), segment(rest_x));
    case 2: {
      const auto a = point(at(common[0])), b = point(at(common[1])), c = point(at(rest_x[0])),
                 d = point(at(rest_y[0]));
      return CGAL::coplanar(a, b, c, d) && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
    }
    default:
      return true;
  }
}

Crossing crossing(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int sp = static_cast<int>(orient3d(a, b, c, p)),
            sq = static_cast<int>(orient3d(a, b, c, q));
  if (sp == sq && sp != 0) return Crossing::None;
  const int u = static_cast<int>(orient3d(p, q, a, b)), v = static_cast<int>(orient3d(p, q, b, c)),
            w = static_cast<int>(orient3d(p, q, c, a));
  if (std::min({u, v, w}) < 0 && std::max({u, v, w}) > 0) return Crossing::None;
  return sp * sq < 0 && u == v && v == w && u != 0 ? Crossing::Proper : Crossing::Unclear;
}

}  // namespace kaboum::geom
