#pragma once

// Integrals of polynomials of degree two over solids, in rational numbers. Internal to kaboum_geom.

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/moments.h>

#include <CGAL/Gmpq.h>
#include <CGAL/Mpzf.h>

#include <array>
#include <utility>

namespace kaboum::geom {
namespace exact_integrals {

using Dyadic = CGAL::Mpzf;
using Rational = CGAL::Gmpq;

/// An interval of rational numbers; operations are exact.
struct Range {
  Rational lower = 0, upper = 0;

  Range() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number is an interval
  Range(const Rational& x) : lower(x), upper(x) {}
  Range(Rational from, Rational to) : lower(std::move(from)), upper(std::move(to)) {}
};

inline Range operator+(const Range& a, const Range& b) {
  return {a.lower + b.lower, a.upper + b.upper};
}
inline Range operator-(const Range& a) { return {-a.upper, -a.lower}; }
inline Range operator-(const Range& a, const Range& b) { return a + -b; }
inline Range operator*(const Range& a, const Range& b) {
  if (a.lower == a.upper)
    return a.lower < 0 ? Range(a.lower * b.upper, a.lower * b.lower)
                       : Range(a.lower * b.lower, a.lower * b.upper);
  if (b.lower == b.upper) return b * a;
  const auto [least, most] =
      std::minmax({a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper});
  return {least, most};
}
/// @pre the interval is above 0.
inline Range inverse(const Range& a) { return {Rational(1) / a.upper, Rational(1) / a.lower}; }

inline Range widened(const Range& a, const Rational& by) { return {a.lower - by, a.upper + by}; }

/// The pairs of axes of products, as MassOf has them.
inline constexpr std::array<std::pair<int, int>, 6> kPairs{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

inline int pair_of(int i, int k) {
  if (i == k) return i;
  return 2 + i + k;  // xy, xz, yz
}

/// Integrals of 1, x, y, z and of the six products.
struct Integrals {
  Range one;
  std::array<Range, 3> first;
  std::array<Range, 6> second;

  [[nodiscard]] const Range& product(int i, int k) const { return second[pair_of(i, k)]; }

  Integrals& operator+=(const Integrals& o) {
    one = one + o.one;
    for (int i = 0; i < 3; ++i) first[i] = first[i] + o.first[i];
    for (int p = 0; p < 6; ++p) second[p] = second[p] + o.second[p];
    return *this;
  }
};

inline bool has_volume(const Box3& box) { return (box.min.array() < box.max.array()).all(); }

/// Bounds of the integrals over any part of a solid. @param volume  from 0 to that of the solid;
/// negative ones are of what is taken away
inline Integrals of_parts(const std::array<Range, 3>& box, const Range& volume) {
  Integrals out;
  out.one = volume;
  for (int i = 0; i < 3; ++i) out.first[i] = volume * box[i];
  for (int p = 0; p < 6; ++p) {
    const auto [i, k] = kPairs[p];
    Range factor = box[i] * box[k];
    if (i == k && factor.lower < 0) factor.lower = 0;
    out.second[p] = volume * factor;
  }
  return out;
}

/// What any part of the box may have.
inline Integrals of_parts(const Box3& box) {
  std::array<Range, 3> x;
  Rational volume = 1;
  for (int i = 0; i < 3; ++i) {
    x[i] = {Rational(box.min[i]), Rational(box.max[i])};
    volume *= x[i].upper - x[i].lower;
  }
  return of_parts(x, {0, volume});
}

/// Of the solid moved.
inline Integrals shifted(const Integrals& a, const Vec3& by) {
  if (by.isZero(0)) return a;
  const std::array<Rational, 3> t{Rational(by.x()), Rational(by.y()), Rational(by.z())};
  Integrals out = a;
  for (int i = 0; i < 3; ++i) out.first[i] = a.first[i] + Range(t[i]) * a.one;
  for (int p = 0; p < 6; ++p) {
    const auto [i, k] = kPairs[p];
    out.second[p] = a.second[p] + Range(t[k]) * a.first[i] + Range(t[i]) * a.first[k] +
                    Range(t[i] * t[k]) * a.one;
  }
  return out;
}

inline Integrals operator-(const Integrals& a) {
  Integrals out;
  out.one = -a.one;
  for (int i = 0; i < 3; ++i) out.first[i] = -a.first[i];
  for (int p = 0; p < 6; ++p) out.second[p] = -a.second[p];
  return out;
}

/// Sums over triangles, without their denominators: 6, 24 and 120.
struct Sums {
  Dyadic one = 0;
  std::array<Dyadic, 3> first{Dyadic(0), Dyadic(0), Dyadic(0)};
  std::array<Dyadic, 6> second{Dyadic(0), Dyadic(0), Dyadic(0), Dyadic(0), Dyadic(0), Dyadic(0)};

  /// @param v  the corners
  void add(const std::array<std::array<Dyadic, 3>, 3>& v) {
    std::array<Dyadic, 3> s;
    for (int i = 0; i < 3; ++i) s[i] = v[0][i] + v[1][i] + v[2][i];
    const Dyadic volume = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                          v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                          v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    if (CGAL::sign(volume) == CGAL::ZERO) return;
    one = one + volume;
    for (int i = 0; i < 3; ++i) first[i] = first[i] + volume * s[i];
    for (int p = 0; p < 6; ++p) {
      const auto [i, k] = kPairs[p];
      const Dyadic sum = s[i] * s[k] + v[0][i] * v[0][k] + v[1][i] * v[1][k] + v[2][i] * v[2][k];
      second[p] = second[p] + volume * sum;
    }
  }

  [[nodiscard]] Integrals integrals() const {
    Integrals out;
    out.one = Rational(one) / Rational(6);
    for (int i = 0; i < 3; ++i) out.first[i] = Rational(first[i]) / Rational(24);
    for (int p = 0; p < 6; ++p) out.second[p] = Rational(second[p]) / Rational(120);
    return out;
  }
};

}  // namespace exact_integrals

struct Moments::Numbers {
  exact_integrals::Integrals sum;
  exact_integrals::Integrals surplus;  ///< of `sum` over the solid
  bool overlaps = false;               ///< `surplus` is not known to be nothing

  [[nodiscard]] exact_integrals::Integrals of_solid() const {
    exact_integrals::Integrals out = sum;
    out.one = out.one - surplus.one;
    for (int i = 0; i < 3; ++i) out.first[i] = out.first[i] - surplus.first[i];
    for (int p = 0; p < 6; ++p) out.second[p] = out.second[p] - surplus.second[p];
    return out;
  }
};

}  // namespace kaboum::geom
