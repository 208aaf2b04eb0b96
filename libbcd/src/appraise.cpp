#include "appraise.h"

#include <algorithm>
#include <cmath>

namespace kaboum::bcd {

Appraisal appraise(std::span<const Vec3> points, const Solid& solid, geom::HullBuilder& builder,
                   bool shaken, double density) {
  Appraisal out;
  static thread_local std::vector<Vec3> moved;
  if (shaken && !points.empty()) {
    Box3 extent;
    for (const Vec3& p : points) extent.extend(p);
    const double amount = 1e-9 * extent.diagonal() / 0x1p31;
    moved.resize(points.size());
    std::uint32_t state = 1;
    const auto next = [&] {
      state = state * 1664525U + 1013904223U;
      return amount * (static_cast<double>(state) - 0x1p31);
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double x = next(), y = next(), z = next();
      moved[i] = points[i] + Vec3(x, y, z);
    }
    points = moved;
  }
  if (!builder.build(points)) return out;
  out.flat = false;
  Box3 box;
  for (const std::uint32_t v : builder.vertices()) box.extend(points[v]);
  const double unit = std::max(1.5 * solid.spacing(), box.diagonal() / density);
  const Vec3 center = box.center();
  // A point that stands for `share` of the area.
  const auto sample = [&](const Vec3& p, double share) {
    const double d = solid.field(p);
    if (d <= 0) return;
    out.fourth += share * d * d * d * d;
    if (d > out.worst) {
      out.worst = d;
      out.at = p;
    }
  };
  for (const Triangle& t : builder.triangles()) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const Vec3 ab = b - a, ac = c - a;
    const Vec3 normal = ab.cross(ac);
    const double area = 0.5 * normal.norm();
    out.volume += normal.dot(a - center) / 6;
    const double longest =
        std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()}));
    // Pits are often widest below a hull's edge.
    for (int k = 0; k < 3; ++k) {
      if (t[k] > t[(k + 1) % 3]) continue;
      const Vec3 &p = points[t[k]], &q = points[t[(k + 1) % 3]];
      const int parts = std::clamp(static_cast<int>(std::ceil((q - p).norm() / unit)), 1, 16);
      for (int i = 1; i < 2 * parts; i += 2) {
        sample(p + (0.5 * i / parts) * (q - p), 0);
      }
    }
    // Slivers need few samples across.
    const double height = longest > 0 ? 2 * area / longest : 0;
    const int m = std::clamp(static_cast<int>(std::ceil(longest / unit)), 1, 16);
    const int rows = std::clamp(static_cast<int>(std::ceil(height / unit)), 1, 16);
    if (rows >= m / 2) {
      const double share = area / (m * m);
      for (int i = 0; i < m; ++i) {
        for (int j = 0; j < 2 * (m - i) - 1; ++j) {
          // Centroids of the m² similar triangles.
          const double s = (i + (j % 2 == 0 ? 1.0 : 2.0) / 3) / m;
          const int row = j / 2;
          const double r = (row + (j % 2 == 0 ? 1.0 : 2.0) / 3) / m;
          sample(a + s * ab + r * ac, share);
        }
      }
    } else {
      // A sliver: along the median to the longest side's ends.
      const Vec3* e[3] = {&a, &b, &c};
      int k = 0;
      double l = -1;
      for (int i = 0; i < 3; ++i) {
        const double x = (*e[(i + 1) % 3] - *e[i]).squaredNorm();
        if (x > l) {
          l = x;
          k = i;
        }
      }
      const Vec3 &p0 = *e[k], &p1 = *e[(k + 1) % 3], &top = *e[(k + 2) % 3];
      const double share = area / m;
      for (int i = 0; i < m; ++i) {
        const Vec3 base = p0 + ((i + 0.5) / m) * (p1 - p0);
        sample(base + (top - base) / 3, share);
      }
    }
  }
  for (const Solid::Probe& probe : solid.probes()) {
    const Vec3& p = probe.point;
    if ((p.array() <= box.min.array()).any() || (p.array() >= box.max.array()).any()) continue;
    bool inside = true;
    for (const Triangle& t : builder.triangles()) {
      const Vec3& a = points[t[0]];
      if ((points[t[1]] - a).cross(points[t[2]] - a).dot(p - a) < 0) continue;
      inside = false;
      break;
    }
    if (!inside) continue;
    const double d = probe.distance;
    out.fourth += solid.probe_area() * d * d * d * d;
    if (d > out.worst) {
      out.worst = d;
      out.at = p;
    }
  }
  return out;
}

}  // namespace kaboum::bcd
