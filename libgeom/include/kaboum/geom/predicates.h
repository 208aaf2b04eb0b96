#pragma once

#include <kaboum/geom/mesh.h>

#include <algorithm>
#include <cmath>

namespace kaboum::geom {

/// Sign of a determinant, decided exactly.
enum class Sign : int { Negative = -1, Zero = 0, Positive = 1 };

namespace detail {
Sign orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
Sign orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy);

/// Rounded determinant of (b−a, c−a, d−a), and what its rounding error is measured by.
struct Filtered {
  double det;
  double permanent;  ///< the determinant's expansion with absolute values
  double extent;     ///< largest |coordinate| of d − a
};

inline Filtered orient3d_filtered(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double bx = b.x() - a.x(), by = b.y() - a.y(), bz = b.z() - a.z();
  const double cx = c.x() - a.x(), cy = c.y() - a.y(), cz = c.z() - a.z();
  const double dx = d.x() - a.x(), dy = d.y() - a.y(), dz = d.z() - a.z();
  const double m1 = by * cz, m2 = bz * cy, m3 = bz * cx, m4 = bx * cz, m5 = bx * cy, m6 = by * cx;
  const double det = dx * (m1 - m2) + dy * (m3 - m4) + dz * (m5 - m6);
  const double permanent = std::abs(dx) * (std::abs(m1) + std::abs(m2)) +
                           std::abs(dy) * (std::abs(m3) + std::abs(m4)) +
                           std::abs(dz) * (std::abs(m5) + std::abs(m6));
  return {det, permanent, std::max(std::abs(dx), std::max(std::abs(dy), std::abs(dz)))};
}
}  // namespace detail

/// Side of d with respect to the plane through a, b, c: Positive when d lies on the side from which
/// a, b, c appear counter-clockwise (the outer side of a triangle), Zero on the plane.
///
/// Exact for all finite doubles. A rounded determinant decides when it exceeds its error bound
/// (docs/algorithms/bounding-mesh.md, "The filter"); exact arithmetic (CGAL) decides the rest.
///
/// @param exact_calls  incremented, when not null, each time exact arithmetic was needed.
inline Sign orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                     std::uint64_t* exact_calls = nullptr) {
  const auto [det, permanent, extent] = detail::orient3d_filtered(a, b, c, d);
  // Rounding: at most (7 + 56·2^-53)·2^-53 · permanent < 7.8e-16 · permanent (Shewchuk 1997).
  // Underflow: six products err by at most 2^-1074 each, times extent; inside the window that is
  // below 1e-221 < 1e-16 · permanent. Overflow: the permanent would not be finite.
  if (permanent > 1e-200 && permanent < 1e300 && extent < 1e100) {
    const double bound = 1e-15 * permanent;
    if (det > bound) return Sign::Positive;
    if (det < -bound) return Sign::Negative;
  }
  if (exact_calls != nullptr) ++*exact_calls;
  return detail::orient3d_exact(a, b, c, d);
}

/// Side of c with respect to the directed line a → b in the plane: Positive on the left.
/// Exact for all finite doubles.
inline Sign orient2d(double ax, double ay, double bx, double by, double cx, double cy) {
  const double l = (ax - cx) * (by - cy);
  const double r = (ay - cy) * (bx - cx);
  const double permanent = std::abs(l) + std::abs(r);
  if (permanent > 1e-280 && permanent < 1e300) {
    // Four roundings per term: (3 + 16·2^-53)·2^-53 · permanent (Shewchuk), with margin.
    const double bound = 4.5e-16 * permanent;
    if (l - r > bound) return Sign::Positive;
    if (l - r < -bound) return Sign::Negative;
  }
  return detail::orient2d_exact(ax, ay, bx, by, cx, cy);
}

}  // namespace kaboum::geom
