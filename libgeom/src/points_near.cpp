// A decision for several points and a triangle, by vectors of four. Source of the weights:
// [ericson2005] §5.1.5; of the bound: docs/algorithms/distances.md.
#include <kaboum/base/processor.h>
#include <kaboum/geom/points_near.h>
#include <kaboum/geom/rounding.h>

#include <algorithm>
#include <cmath>

#include "upper_distances.h"

namespace kaboum::geom {
namespace {

/// Four numbers that are computed with at once. Operations round as those of single numbers do.
using Double4 = double __attribute__((vector_size(32)));
struct FourVectors {
  Double4 of[3];  // by axis
};

[[gnu::always_inline]] inline void minus_dot(const Vec3& a, const FourVectors& b, Double4& out) {
  out = -(a.x() * b.of[0] + a.y() * b.of[1] + a.z() * b.of[2]);
}

/// Weights of the points of a triangle that are nearest to four points: s / of and t / of, as
/// closest_weights has them of one.
struct FourWeights {
  Double4 s, t, of;

  /// @param x  the triangle's first corner, from the points.
  [[gnu::always_inline]] FourWeights(const FourVectors& x, const Vec3& ab, const Vec3& ac) {
    const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
    Double4 d1, d2;
    minus_dot(ab, x, d1);
    minus_dot(ac, x, d2);
    const Double4 d3 = d1 - bb, d4 = d2 - bc, d5 = d1 - bc, d6 = d2 - cc;
    const Double4 va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    const Double4 zero{}, one = zero + 1;
    s = vb, t = vc, of = va + vb + vc;
    const auto put = [&](const auto& where, const Double4& u, const Double4& v, const Double4& w) {
      s = where ? u : s, t = where ? v : t, of = where ? w : of;
    };
    // The last that holds counts.
    const Double4 along = d4 - d3, whole = along + (d5 - d6);
    put((va <= 0) & (along >= 0) & (d5 >= d6), whole - along, along, whole);
    put((vb <= 0) & (d2 >= 0) & (d6 <= 0), zero, d2, d2 - d6);
    put((d6 >= 0) & (d5 <= d6), zero, one, one);
    put((vc <= 0) & (d1 >= 0) & (d3 <= 0), d1, zero, d1 - d3);
    put((d3 >= 0) & (d4 <= d3), one, zero, one);
    put((d1 <= 0) & (d2 <= 0), zero, zero, one);
  }
};

/// How far points of a triangle, found by rounded weights, are from four points.
struct FourDistances {
  Double4 squared{};
  Double4 size{};  ///< largest |coordinate| of the triangle's corners, from the points

  [[gnu::always_inline]] FourDistances(const Vec3* const (&point)[4], const Vec3& a, const Vec3& ab,
                                       const Vec3& ac) {
    FourVectors x{};
    for (int k = 0; k < 3; ++k)
      x.of[k] = a[k] - Double4{(*point[0])[k], (*point[1])[k], (*point[2])[k], (*point[3])[k]};
    const FourWeights w(x, ab, ac);
    const Double4 zero{}, one = zero + 1;
    Double4 s = w.of > 0 ? w.s / w.of : zero, t = w.of > 0 ? w.t / w.of : zero;
    s = s > 0 ? s : zero;
    s = s < 1 ? s : one;
    t = t > 0 ? t : zero;
    t = t < 1 - s ? t : 1 - s;
    const auto add = [&](const Double4& from, double u, double v) {
      const Double4 q = from + s * u + t * v;
      squared += q * q;
      for (const Double4& corner : {from, from + u, from + v}) {
        const Double4 length = corner < 0 ? -corner : corner;
        size = size < length ? length : size;
      }
    };
    add(x.of[0], ab.x(), ac.x());
    add(x.of[1], ab.y(), ac.y());
    add(x.of[2], ab.z(), ac.z());
  }
};

[[gnu::always_inline]] inline bool four_within(const Vec3* const (&point)[4], const Vec3& a,
                                               const Vec3& ab, const Vec3& ac, double radius) {
  const FourDistances d(point, a, ab, ac);
  const Double4 left = radius - kDistanceRounding * d.size;
  const auto within = (left > 0) & (d.squared * (1 + 4 * kDistanceRounding) <= left * left);
  return (within[0] & within[1] & within[2] & within[3]) != 0;
}

[[gnu::always_inline]] inline bool each_within(std::span<const Vec3> points, const Vec3& a,
                                               const Vec3& b, const Vec3& c, double radius) {
  const Vec3 ab = b - a, ac = c - a;
  for (std::size_t i = 0; i < points.size(); i += 4) {
    const auto at = [&](std::size_t k) { return &points[std::min(i + k, points.size() - 1)]; };
    const Vec3* const four[4] = {at(0), at(1), at(2), at(3)};
    if (!four_within(four, a, ab, ac, radius)) return false;
  }
  return true;
}

[[gnu::always_inline]] inline void each_upper(std::span<const Vec3> points, const Vec3& a,
                                              const Vec3& b, const Vec3& c, double* out) {
  const Vec3 ab = b - a, ac = c - a;
  for (std::size_t i = 0; i < points.size(); i += 4) {
    const auto at = [&](std::size_t k) { return &points[std::min(i + k, points.size() - 1)]; };
    const Vec3* const four[4] = {at(0), at(1), at(2), at(3)};
    const FourDistances d(four, a, ab, ac);
    for (std::size_t k = 0; k < 4 && i + k < points.size(); ++k)
      out[i + k] =
          std::sqrt(d.squared[k]) * (1 + kDistanceRounding) + kDistanceRounding * d.size[k];
  }
}

#ifdef KABOUM_AVX2
[[gnu::target("avx2")]] void each_upper_avx2(std::span<const Vec3> points, const Vec3& a,
                                             const Vec3& b, const Vec3& c, double* out) {
  each_upper(points, a, b, c, out);
}
[[gnu::target("avx2")]] bool each_within_avx2(std::span<const Vec3> points, const Vec3& a,
                                              const Vec3& b, const Vec3& c, double radius) {
  return each_within(points, a, b, c, radius);
}
#endif

}  // namespace

void upper_distances(std::span<const Vec3> points, const Vec3& a, const Vec3& b, const Vec3& c,
                     double* out) {
#ifdef KABOUM_AVX2
  if (has_avx2()) return each_upper_avx2(points, a, b, c, out);
#endif
  each_upper(points, a, b, c, out);
}

bool all_within(std::span<const Vec3> points, const Vec3& a, const Vec3& b, const Vec3& c,
                double radius) {
#ifdef KABOUM_AVX2
  if (has_avx2()) return each_within_avx2(points, a, b, c, radius);
#endif
  return each_within(points, a, b, c, radius);
}

}  // namespace kaboum::geom
