#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/predicates.h>

#include <CGAL/Mpzf.h>

#include <array>
#include <cmath>
#include <optional>

#include "rounding.h"

/// Two number types for one set of formulas: rounded with a running error bound, and exact.
/// docs/algorithms/exact-inclusion.md, "Arithmetic".
namespace kaboum::verify {

using geom::Sign;
using geom::Vec3;

/// Dyadic numbers of any length: sums, differences and products of doubles are exact.
using Exact = CGAL::Mpzf;

/// A rounded value and a bound of its error: |true − value| ≤ error. Overflow makes one of them
/// infinite or NaN, and then no sign is certain.
struct Approx {
  double value = 0;
  double error = 0;
};

inline Approx operator+(const Approx& a, const Approx& b) {
  const double value = a.value + b.value;
  return {value, (a.error + b.error + std::abs(value) * kUnit) * kGrowth};
}
inline Approx operator-(const Approx& a) { return {-a.value, a.error}; }
inline Approx operator-(const Approx& a, const Approx& b) { return a + (-b); }
inline Approx operator*(const Approx& a, const Approx& b) {
  if ((a.value == 0 && a.error == 0) || (b.value == 0 && b.error == 0)) return {};
  const double value = a.value * b.value;
  return {value, (std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error +
                  std::abs(value) * kUnit) *
                         kGrowth +
                     kTiny};
}

/// nullopt when the error bound leaves it open.
inline std::optional<Sign> sign_of(const Approx& a) {
  if (a.value > a.error) return Sign::Positive;
  if (a.value < -a.error) return Sign::Negative;
  if (a.value == 0 && a.error == 0) return Sign::Zero;
  return std::nullopt;
}
inline Sign sign_of(const Exact& a) { return static_cast<Sign>(static_cast<int>(CGAL::sign(a))); }

template <class Number>
Number difference(double a, double b);
template <>
inline Approx difference<Approx>(double a, double b) {
  const double value = a - b;
  return {value, std::abs(value) * kUnit};
}
template <>
inline Exact difference<Exact>(double a, double b) {
  return Exact(a) - Exact(b);
}

template <class Number>
Number integer(int n);
template <>
inline Approx integer<Approx>(int n) {
  return {static_cast<double>(n), 0};
}
template <>
inline Exact integer<Exact>(int n) {
  return {n};
}

inline Approx rounded(const Exact& x) {
  const auto [low, high] = x.to_interval();
  const double value = 0.5 * low + 0.5 * high;
  return {value, (high - low) * kGrowth + (low == high ? 0 : kTiny)};
}

template <class Number>
using Triple = std::array<Number, 3>;

/// x·y of two triples.
template <class Number>
Number dot(const Triple<Number>& x, const Triple<Number>& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/// Determinant of (b−a, c−a, d−a): positive when d is on the side of the plane from which a, b, c
/// run counter-clockwise.
template <class Number>
Number orient3d_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Number bx = difference<Number>(b.x(), a.x()), by = difference<Number>(b.y(), a.y()),
               bz = difference<Number>(b.z(), a.z());
  const Number cx = difference<Number>(c.x(), a.x()), cy = difference<Number>(c.y(), a.y()),
               cz = difference<Number>(c.z(), a.z());
  const Number dx = difference<Number>(d.x(), a.x()), dy = difference<Number>(d.y(), a.y()),
               dz = difference<Number>(d.z(), a.z());
  return dx * (by * cz - bz * cy) + dy * (bz * cx - bx * cz) + dz * (bx * cy - by * cx);
}

/// Determinant of (b−a, c−a) in the projection along `axis`.
template <class Number>
Number orient2d_value(int axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return difference<Number>(b[u], a[u]) * difference<Number>(c[v], a[v]) -
         difference<Number>(b[v], a[v]) * difference<Number>(c[u], a[u]);
}

inline Sign orient2d(int axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return geom::orient2d(a[u], a[v], b[u], b[v], c[u], c[v]);
}

inline int to_int(Sign s) { return static_cast<int>(s); }
inline Sign opposite(Sign s) { return static_cast<Sign>(-static_cast<int>(s)); }

}  // namespace kaboum::verify
