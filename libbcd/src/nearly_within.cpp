#include "nearly_within.h"

#include <algorithm>

#include "cell.h"

namespace kaboum::bcd {
namespace {

/// The planes of the facets, each once as far as rounding lets see.
std::vector<Plane> planes_of(const Mesh& body, double slack) {
  std::vector<Plane> out;
  for (const Triangle& t : body.triangles) {
    const Vec3& a = body.vertices[t[0]];
    const Vec3 n = (body.vertices[t[1]] - a).cross(body.vertices[t[2]] - a);
    const double length = n.norm();
    if (!(length > 0)) continue;
    const Plane plane{n / length, n.dot(a) / length};
    if (std::none_of(out.begin(), out.end(), [&](const Plane& p) {
          return (p.n - plane.n).squaredNorm() < 1e-20 && std::abs(p.d - plane.d) < slack;
        }))
      out.push_back(plane);
  }
  return out;
}

/// Whether a point of the triangle is below all planes.
bool meets(std::array<Vec3, 3> triangle, const std::vector<Plane>& planes) {
  std::vector<Vec3> polygon(triangle.begin(), triangle.end()), next;
  for (const Plane& plane : planes) {
    next.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double hp = plane.height(p), hq = plane.height(q);
      if (hp <= 0) next.push_back(p);
      if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) next.emplace_back(p + hp / (hp - hq) * (q - p));
    }
    std::swap(polygon, next);
    if (polygon.empty()) return false;
  }
  return true;
}

}  // namespace

bool nearly_within(const Mesh& body, const Solid& solid, double distance, double slack) {
  const Box3 box = geom::bounding_box(body);
  const std::vector<Plane> planes = planes_of(body, slack);
  // By how much facets move: at a corner of a box the distance is √3 times that, at sharper ones
  // more.
  for (const double share : {0.55, 0.3, 0.1}) {
    std::vector<Plane> inner = planes;
    Cell rest = Cell::of(box);
    for (Plane& plane : inner) {
      plane.d -= share * distance;
      rest = clip(rest, plane, true, 0);
    }
    if (rest.corners.size() < 4) continue;
    // Whatever rounding did to them, the corners are below these planes.
    for (Plane& plane : inner) plane.d += slack;
    const auto below = [&](const Vec3& p) {
      return std::all_of(inner.begin(), inner.end(),
                         [&](const Plane& plane) { return plane.height(p) <= 0; });
    };
    if (!std::all_of(rest.corners.begin(), rest.corners.end(), below)) continue;
    const bool near = std::all_of(body.vertices.begin(), body.vertices.end(), [&](const Vec3& v) {
      return std::any_of(rest.corners.begin(), rest.corners.end(), [&](const Vec3& corner) {
        return (v - corner).norm() + slack <= distance;
      });
    });
    if (!near || !solid.contains(rest.center())) continue;
    for (Plane& plane : inner) plane.d += slack;  // for the rounding of clipped triangles
    const Mesh& mesh = solid.mesh();
    const bool crossed =
        std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
          const std::array<Vec3, 3> corner{mesh.vertices[t[0]], mesh.vertices[t[1]],
                                           mesh.vertices[t[2]]};
          Box3 extent;
          for (const Vec3& p : corner) extent.extend(p);
          return (extent.min.array() <= box.max.array()).all() &&
                 (extent.max.array() >= box.min.array()).all() && meets(corner, inner);
        });
    if (!crossed) return true;
  }
  return false;
}

}  // namespace kaboum::bcd
