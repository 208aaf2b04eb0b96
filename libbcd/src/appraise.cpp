#include "appraise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "principal_box.h"

namespace kaboum::bcd {
namespace {

/// Points in one plane, moved to both sides of it by a millionth of the diagonal.
std::vector<Vec3> thickened(std::span<const Vec3> points, double diagonal) {
  const std::optional<PrincipalBox> box = principal_box(points);
  if (!box) return {};
  const double step = 1e-6 * diagonal;
  std::vector<Vec3> out(points.begin(), points.end());
  for (int k = 0; k < 2; ++k) {
    if (box->high[k] - box->low[k] > step) continue;
    const std::size_t size = out.size();
    for (std::size_t i = 0; i < size; ++i) {
      out.emplace_back(out[i] + step * box->axes.col(k));
      out[i] -= step * box->axes.col(k);
    }
  }
  return out;
}

/// A facet: a corner, and a normal with its length.
struct HullSide {
  Vec3 corner, normal;
  double length;
};

/// Tells the work of an appraisal, however it ends.
struct Counted {
  Work& work;
  std::size_t points;
  const std::uint64_t &samples, &measured;
  ~Counted() { work.add(250 * points + 80 * samples + 300 * measured); }
};

}  // namespace

bool spans_beyond(std::span<const Vec3> points, const Solid& solid, double limit) {
  static const std::array<Vec3, 7> kDirections{Vec3(1, 0, 0), Vec3(0, 1, 0),  Vec3(0, 0, 1),
                                               Vec3(1, 1, 1), Vec3(-1, 1, 1), Vec3(1, -1, 1),
                                               Vec3(1, 1, -1)};
  std::array<const Vec3*, 14> extreme{};
  for (std::size_t k = 0; k < kDirections.size(); ++k) {
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
          return kDirections[k].dot(p) < kDirections[k].dot(q);
        });
    extreme[2 * k] = &*low;
    extreme[2 * k + 1] = &*high;
  }
  for (std::size_t i = 0; i < extreme.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 middle = 0.5 * (*extreme[i] + *extreme[j]);
      if (solid.distance_above(limit, middle, solid.field(middle)) > limit) return true;
    }
  return false;
}

Appraisal appraise(std::span<const Vec3> points, const Solid& solid, geom::HullBuilder& builder,
                   bool shaken, double limit) {
  constexpr double density = 14;  // of samples, per diagonal
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
  std::vector<Vec3> thick;
  out.flat = !builder.build(points);
  std::uint64_t samples = 0, measured = 0;
  const Counted counted{solid.work(), points.size(), samples, measured};
  if (out.flat) {
    thick = thickened(points, solid.diagonal());
    points = thick;
    if (!builder.build(points)) return out;
  }
  Box3 box;
  for (const std::uint32_t v : builder.vertices()) box.extend(points[v]);
  const double unit = std::max(1.5 * solid.spacing(), box.diagonal() / density);
  const Vec3 center = box.center();
  // Where sheets and walls are thinner than the grid, the field is far above the distance: this is
  // measured, where the field is largest first.
  static thread_local std::vector<std::pair<double, Vec3>> open;
  open.clear();
  const auto measure = [&](double field, const Vec3& p) {
    ++measured;
    const double d = solid.distance_above(out.worst, p, field);
    if (d <= out.worst) return;
    out.worst = d;
    out.at = p;
  };
  const auto raise = [&](const Vec3& p, double field) {
    if (field > limit) {
      measure(field, p);
    } else {
      open.emplace_back(field, p);
    }
  };
  // A point that stands for `share` of the area.
  const auto sample = [&](const Vec3& p, double share) {
    ++samples;
    const double d = solid.field(p);
    if (d <= 0) return;
    out.fourth += share * d * d * d * d;
    raise(p, d);
  };
  for (const Triangle& t : builder.triangles()) {
    if (out.worst > limit) return out;
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
  // The facets' normals, the one first that left out the last probe.
  static thread_local std::vector<HullSide> sides;
  sides.clear();
  if (!solid.probes().empty()) {
    for (const Triangle& t : builder.triangles()) {
      const Vec3& a = points[t[0]];
      const Vec3 normal = (points[t[1]] - a).cross(points[t[2]] - a);
      sides.push_back({a, normal, normal.norm()});
    }
  }
  std::size_t likely = 0;
  for (const Solid::Probe& probe : solid.probes()) {
    const Vec3& p = probe.point;
    const double near = probe.near();
    if ((p.array() <= box.min.array() - near).any() || (p.array() >= box.max.array() + near).any())
      continue;
    double outside = 0;
    Vec3 back = Vec3::Zero();
    const auto look_from = [&](std::size_t i) {
      const auto& [a, normal, length] = sides[i];
      const double height = normal.dot(p - a);
      if (!(height > outside * length)) return false;
      outside = height / length;
      back = normal / length;
      return outside >= near;
    };
    if (look_from(likely)) continue;
    outside = 0;
    std::size_t side = 0;
    while (side < sides.size() && !look_from(side)) ++side;
    samples += side / 4 + 1;
    if (side < sides.size()) {
      likely = side;
      continue;
    }
    const double d = probe.distance - outside;
    out.fourth += solid.probe_area() * d * d * d * d;
    raise(p - outside * back, d);
  }
  if (out.worst > limit) return out;
  const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::make_heap(open.begin(), open.end(), less);
  for (; !open.empty() && open.front().first > out.worst; open.pop_back()) {
    measure(open.front().first, open.front().second);
    std::pop_heap(open.begin(), open.end(), less);
  }
  return out;
}

}  // namespace kaboum::bcd
