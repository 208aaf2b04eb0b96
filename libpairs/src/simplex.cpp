// The point of a simplex that is nearest to the origin, by the regions of Voronoi: [ericson2005]
// §5.1.

#include "simplex.h"

#include <algorithm>

namespace kaboum::pairs::detail {
namespace {

struct Nearest {
  std::array<double, 4> weights{};
  Vec3 point = Vec3::Zero();
};

Nearest of_segment(const Simplex& s, int i, int j) {
  const Vec3 &a = s.points[i], d = s.points[j] - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp(-a.dot(d) / length, 0.0, 1.0) : 0;
  Nearest out;
  out.weights[i] = 1 - t;
  out.weights[j] += t;
  out.point = a + t * d;
  return out;
}

Nearest nearer(const Nearest& x, const Nearest& y) {
  return y.point.squaredNorm() < x.point.squaredNorm() ? y : x;
}

Nearest of_triangle(const Simplex& s, int i, int j, int k) {
  const Vec3 &a = s.points[i], ab = s.points[j] - a, ac = s.points[k] - a, n = ab.cross(ac);
  const double area = n.squaredNorm();
  if (area > 0) {
    const double v = (-a).cross(ac).dot(n) / area, w = ab.cross(-a).dot(n) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) {
      Nearest out;
      out.weights[i] = 1 - v - w;
      out.weights[j] = v;
      out.weights[k] = w;
      out.point = a.dot(n) / area * n;
      return out;
    }
  }
  return nearer(nearer(of_segment(s, i, j), of_segment(s, j, k)), of_segment(s, i, k));
}

Nearest of_tetrahedron(const Simplex& s) {
  constexpr std::array<std::array<int, 4>, 4> kFaces{
      {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}}};
  bool inside = true, any = false;
  Nearest best;
  for (const auto& f : kFaces) {
    const Vec3 &a = s.points[f[0]], n = (s.points[f[1]] - a).cross(s.points[f[2]] - a);
    const double origin = -a.dot(n), other = (s.points[f[3]] - a).dot(n);
    if (origin * other > 0) continue;
    inside = false;
    const Nearest here = of_triangle(s, f[0], f[1], f[2]);
    best = any ? nearer(best, here) : here;
    any = true;
  }
  if (!inside) return best;
  // The origin's barycentric coordinates.
  double sum = 0;
  for (const auto& f : kFaces) {
    const Vec3 &a = s.points[f[0]], n = (s.points[f[1]] - a).cross(s.points[f[2]] - a);
    best.weights[f[3]] = -a.dot(n) / (s.points[f[3]] - a).dot(n);
    sum += best.weights[f[3]];
  }
  best.point.setZero();
  for (double& w : best.weights) w /= sum;
  return best;
}

}  // namespace

Vec3 Simplex::reduce() {
  Nearest nearest;
  switch (size) {
    case 1:
      nearest.weights[0] = 1;
      nearest.point = points[0];
      break;
    case 2:
      nearest = of_segment(*this, 0, 1);
      break;
    case 3:
      nearest = of_triangle(*this, 0, 1, 2);
      break;
    default:
      nearest = of_tetrahedron(*this);
  }
  int kept = 0;
  for (int i = 0; i < size; ++i) {
    if (nearest.weights[i] <= 0) continue;
    points[kept] = points[i];
    on_a[kept] = on_a[i];
    on_b[kept] = on_b[i];
    weights[kept] = nearest.weights[i];
    ++kept;
  }
  size = kept;
  return nearest.point;
}

}  // namespace kaboum::pairs::detail
