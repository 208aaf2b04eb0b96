// The point of a simplex nearest to the origin, by its Voronoi regions (C. Ericson: Real-time
// collision detection, 2005, §5.1, §9.5).

#include "simplex.h"

#include <cmath>
#include <limits>

namespace kaboum::collide::detail {
namespace {

using geom::Vec3;

/// Some corners with their shares.
struct Part {
  std::array<int, 3> corner{};
  std::array<double, 3> share{};
  int size = 0;
};

Part part_of(int i) { return {{i, 0, 0}, {1, 0, 0}, 1}; }

Part part_of(int i, int j, double at) { return {{i, j, 0}, {1 - at, at, 0}, 2}; }

Part nearest_of_segment(const Simplex& s, int i, int j) {
  const Vec3 e = s.vertex[j].w - s.vertex[i].w;
  const double along = -s.vertex[i].w.dot(e), length = e.squaredNorm();
  if (!(along > 0)) return part_of(i);
  if (!(along < length)) return part_of(j);
  return part_of(i, j, along / length);
}

Vec3 point_of(const Simplex& s, const Part& part) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < part.size; ++i) sum += part.share[i] * s.vertex[part.corner[i]].w;
  return sum;
}

/// False where rounding was too large for the part to be a point of the hull.
bool in_range(const Part& part) {
  for (int i = 0; i < part.size; ++i)
    if (!(part.share[i] >= 0 && part.share[i] <= 1)) return false;
  return true;
}

Part nearest_of_edges(const Simplex& s, int i, int j, int k) {
  Part best = nearest_of_segment(s, i, j);
  for (const Part& part : {nearest_of_segment(s, j, k), nearest_of_segment(s, k, i)})
    if (point_of(s, part).squaredNorm() < point_of(s, best).squaredNorm()) best = part;
  return best;
}

Part nearest_of_triangle(const Simplex& s, int i, int j, int k) {
  const Vec3 &a = s.vertex[i].w, &b = s.vertex[j].w, &c = s.vertex[k].w;
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a);
  if (d1 <= 0 && d2 <= 0) return part_of(i);
  const double d3 = -ab.dot(b), d4 = -ac.dot(b);
  if (d3 >= 0 && d4 <= d3) return part_of(j);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return part_of(i, j, d1 / (d1 - d3));
  const double d5 = -ab.dot(c), d6 = -ac.dot(c);
  if (d6 >= 0 && d5 <= d6) return part_of(k);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return part_of(i, k, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return part_of(j, k, (d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double sum = va + vb + vc;
  const Part inside{{i, j, k}, {va / sum, vb / sum, vc / sum}, 3};
  return in_range(inside) ? inside : nearest_of_edges(s, i, j, k);
}

Vec3 keep(Simplex& s, const Part& part) {
  Simplex reduced;
  for (int i = 0; i < part.size; ++i) {
    reduced.share[i] = part.share[i];
    reduced.add(s.vertex[part.corner[i]]);
  }
  s = reduced;
  return point_of(s, {{0, 1, 2}, {s.share[0], s.share[1], s.share[2]}, s.size});
}

Vec3 nearest_of_tetrahedron(Simplex& s) {
  constexpr std::array<std::array<int, 4>, 4> kFaces{
      {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}}};
  Part best;
  double least = std::numeric_limits<double>::infinity();
  std::array<double, 4> share{};
  double sum = 0;
  for (const auto& [i, j, k, opposite] : kFaces) {
    const Vec3& a = s.vertex[i].w;
    const Vec3 n = (s.vertex[j].w - a).cross(s.vertex[k].w - a);
    const double origin = -n.dot(a), other = n.dot(s.vertex[opposite].w - a);
    if (origin * other > 0) {
      share[opposite] = std::abs(origin);
      sum += share[opposite];
      continue;
    }
    const Part part = nearest_of_triangle(s, i, j, k);
    if (!in_range(part)) continue;
    const double distance = point_of(s, part).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = part;
  }
  if (best.size > 0) return keep(s, best);
  Vec3 point = Vec3::Zero();
  for (int i = 0; i < 4; ++i) {
    s.share[i] = share[i] / sum;
    point += s.share[i] * s.vertex[i].w;
  }
  return point;
}

}  // namespace

Vec3 reduce_to_nearest(Simplex& s) {
  if (s.size == 4) return nearest_of_tetrahedron(s);
  const Part part = s.size == 3   ? nearest_of_triangle(s, 0, 1, 2)
                    : s.size == 2 ? nearest_of_segment(s, 0, 1)
                                  : part_of(0);
  return keep(s, part);
}

}  // namespace kaboum::collide::detail
