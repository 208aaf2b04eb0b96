// Tetrahedra that are free of the input: separating planes, certain in spite of rounding.
#include "obstacle.h"

#include <algorithm>
#include <limits>

#include "separation.h"

namespace kaboum::wrap {
namespace {

using Corners = std::array<Vec3, 3>;

/// Whether a plane certainly separates the triangle from the tetrahedron: those along a face of
/// one of them, or along an edge of each, are all that need be tried.
bool apart(const Corners& t, const Tetrahedron& tetrahedron, double clearance) {
  const Vec3& origin = tetrahedron[3];
  Corners a;
  Tetrahedron b;
  Separator separator;
  separator.clearance = clearance;
  for (int i = 0; i < 3; ++i) separator.look_at(a[i] = t[i] - origin);
  for (int i = 0; i < 4; ++i) separator.look_at(b[i] = tetrahedron[i] - origin);
  const auto along = [&](const Vec3& n) { return separator.apart(n, a, b); };
  const Corners edge_a{a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  if (along(edge_a[0].cross(edge_a[1]))) return true;
  const std::array<Vec3, 6> edge_b{b[0], b[1], b[2], b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  if (along(b[0].cross(b[1])) || along(b[1].cross(b[2])) || along(b[2].cross(b[0])) ||
      along(edge_b[3].cross(edge_b[4])))
    return true;
  for (const Vec3& e : edge_a)
    for (const Vec3& f : edge_b)
      if (along(e.cross(f))) return true;
  return false;
}

inline bool overlap(const geom::Box3& a, const geom::Box3& b) {
  bool apart = false;  // without branches
  for (int k = 0; k < 3; ++k) apart |= (a.min[k] > b.max[k]) | (b.min[k] > a.max[k]);
  return !apart;
}

}  // namespace

Obstacle::Obstacle(const geom::Mesh& mesh, double clearance) : query_(mesh), clearance_(clearance) {
  normal_.reserve(mesh.triangles.size());
  for (const geom::Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    normal_.emplace_back((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a));
  }
}

bool Obstacle::beside(std::uint32_t triangle, const geom::Box3& box,
                      std::span<const Tetrahedron> tetrahedra) const {
  const Vec3& n = normal_[triangle];
  const Corners& corners = query_.corners(triangle);
  const Vec3& origin = corners[0];
  Separator separator;
  separator.clearance = clearance_;
  for (const Vec3& p : corners) separator.look_at(p - origin);
  separator.look_at(box.min - origin);
  separator.look_at(box.max - origin);
  const double own_1 = n.dot(corners[1] - origin), own_2 = n.dot(corners[2] - origin);
  const double margin = separator.margin(n);
  const double above = std::max({own_1, own_2, 0.0}) + margin,
               below = std::min({own_1, own_2, 0.0}) - margin;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
    // The last corner is common to all of them.
    for (int k = i == 0 ? 0 : 1; k < 4; ++k) {
      const double d = n.dot(tetrahedra[i][k == 0 ? 3 : k - 1] - origin);
      low = d < low ? d : low;
      high = d > high ? d : high;
    }
    if (!(low > above) && !(high < below)) return false;
  }
  return low > above || high < below;
}

bool Obstacle::clear(std::span<const Tetrahedron> tetrahedra) const {
  geom::Box3 all;
  thread_local std::vector<geom::Box3> boxes;
  boxes.assign(tetrahedra.size(), {});
  for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
    for (const Vec3& p : tetrahedra[i]) boxes[i].extend(p);
    if (clearance_ > 0) {
      const Vec3 wide = Vec3::Constant(2 * clearance_);  // twice: no matter how it is rounded
      boxes[i].extend(Vec3(boxes[i].min - wide));
      boxes[i].extend(Vec3(boxes[i].max + wide));
    }
    all.extend(boxes[i]);
  }
  bool clear = true;
  query_.hierarchy().traverse([&](const geom::Box3& box) { return clear && overlap(box, all); },
                              [&](std::uint32_t triangle) {
                                if (!clear) return;
                                const Corners& corners = query_.corners(triangle);
                                geom::Box3 box;
                                for (const Vec3& p : corners) box.extend(p);
                                if (!overlap(box, all) || beside(triangle, all, tetrahedra)) return;
                                for (std::size_t i = 0; clear && i < tetrahedra.size(); ++i)
                                  clear = !overlap(box, boxes[i]) ||
                                          apart(corners, tetrahedra[i], clearance_);
                              });
  return clear;
}

}  // namespace kaboum::wrap
