#pragma once

#include <kaboum/geom/mesh.h>

#include <algorithm>
#include <cmath>
#include <span>

/// Rounded arithmetic that says "apart" only where that is certain.
namespace kaboum::wrap {

using geom::Vec3;

/// Points relative to one of them, and the largest |coordinate| along each axis.
///
/// A difference of two doubles errs by at most 2^-53 of itself. Let x̃ be the rounded differences, n
/// any vector of doubles and M the largest |x̃| per axis. A rounded n·x̃ then errs by less than
/// (4 · 2^-53 + 2^-53) Σ |n_i| M_i, twice that between two of them, and underflow adds less than
/// 2^-1000: the margin below is ten times that.
struct Separator {
  static constexpr double kError = 1e-14, kTiny = 1e-290;
  static constexpr double kUp = 1 + 1e-12;  ///< covers the rounding of a norm and a product

  Vec3 most = Vec3::Zero();
  double clearance = 0;  ///< that "apart" has to leave; ≥ 0

  void look_at(const Vec3& x) { most = most.cwiseMax(x.cwiseAbs()); }
  [[nodiscard]] double margin(const Vec3& n) const {
    return kError * n.cwiseAbs().dot(most) + kTiny +
           (clearance > 0 ? clearance * kUp * n.norm() : 0);
  }

  /// Whether the plane of normal n has the one convex hull on one side and the other on the other.
  [[nodiscard]] bool apart(const Vec3& n, std::span<const Vec3> a, std::span<const Vec3> b) const {
    double a_low = n.dot(a[0]), a_high = a_low;
    for (const Vec3& p : a.subspan(1)) {
      const double d = n.dot(p);
      a_low = std::min(a_low, d);
      a_high = std::max(a_high, d);
    }
    double b_low = n.dot(b[0]), b_high = b_low;
    for (const Vec3& p : b.subspan(1)) {
      const double d = n.dot(p);
      b_low = std::min(b_low, d);
      b_high = std::max(b_high, d);
    }
    return std::max(b_low - a_high, a_low - b_high) > margin(n);  // false for NaN
  }
};

}  // namespace kaboum::wrap
