#pragma once

#include <kaboum/geom/mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

/// Boxes, and rounded arithmetic that says "apart" only where that is certain.
namespace kaboum::wrap {

using geom::Vec3;

/// Whether two boxes have a point in common. Without branches.
inline bool overlap(const geom::Box3& a, const geom::Box3& b) {
  bool apart = false;
  for (int k = 0; k < 3; ++k) apart |= (a.min[k] > b.max[k]) | (b.min[k] > a.max[k]);
  return !apart;
}

/// What parts ranges along n has to be larger than this.
///
/// Points are taken relative to one of them. A difference of two doubles errs by at most 2^-53 of
/// itself. Let x̃ be the rounded differences, n any vector of doubles and M the largest |x̃_i|. A
/// rounded n·x̃ then errs by less than (4 · 2^-53 + 2^-53) Σ |n_i| M, twice that between two of
/// them, and underflow adds less than 2^-1000: the margin is ten times that. Where a sum may
/// overflow it is infinite.
struct Margin {
  static constexpr double kError = 1e-14, kTiny = 1e-290, kMost = 1e300;
  static constexpr double kUp = 1 + 1e-12;  ///< covers the rounding of a norm and a product

  double size = 0;  ///< Σ |n_i|, rounded
  double fixed = kTiny;

  /// @param clearance  that has to be left; ≥ 0
  Margin(const Vec3& n, double clearance)
      : size(n.cwiseAbs().sum()),
        fixed(kTiny + (clearance > 0 ? clearance * kUp * length(n, size) : 0)) {}
  Margin() = default;

  /// Not below |n| by more than rounding: squares of small numbers are lost.
  static double length(const Vec3& n, double size) {
    const double norm = n.norm();
    return norm > 1e-140 ? norm : size;
  }

  /// @param most  M
  [[nodiscard]] double at(double most) const {
    const double largest = size * most;  // no partial sum of n·x̃ is larger, rounding aside
    return largest < kMost ? kError * largest + fixed : std::numeric_limits<double>::infinity();
  }
};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void extend(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

inline Range range_along(const Vec3& n, std::span<const Vec3> points) {
  Range range;
  for (const Vec3& p : points) range.extend(n.dot(p));
  return range;
}

/// False if the margin is infinite or not a number.
inline bool apart(const Range& a, const Range& b, double margin) {
  return std::max(b.low - a.high, a.low - b.high) > margin;
}

/// A direction, the range of something along it, and the margin it asks for.
struct Axis {
  Vec3 n = Vec3::Zero();
  Range range;
  Margin margin;
};

}  // namespace kaboum::wrap
