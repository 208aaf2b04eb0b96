// How two triangles, or a segment and a triangle, meet; exact.
#include "triangle_contact.h"

#include <kaboum/geom/predicates.h>
#include <kaboum/geom/self_intersection.h>
#include <kaboum/geom/topology.h>

#include <algorithm>

namespace kaboum::geom {

bool meet_improperly(const Mesh& mesh, std::uint32_t t, std::uint32_t u) {
  const auto named = [&](std::uint32_t of) {
    const Triangle& c = mesh.triangles[of];
    return NamedTriangle{c, {mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]}};
  };
  const NamedTriangle a = named(t), b = named(u);
  const auto flat = [](const NamedTriangle& c) { return is_degenerate(c.at[0], c.at[1], c.at[2]); };
  return !flat(a) && !flat(b) && meet_improperly(a, b);
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
