#pragma once

#include <kaboum/geom/convex_set.h>

#include <optional>

#include "number.h"

/// Whether a point is within the radius of a convex core, as signs of polynomials: for rounded and
/// for exact numbers. docs/algorithms/rounded-bodies.md, "Membership".
namespace kaboum::verify {

template <class Number>
Number number(double x);
template <>
inline Approx number<Approx>(double x) {
  return {x, 0};
}
template <>
inline Exact number<Exact>(double x) {
  return {x};
}

template <class Number>
Triple<Number> numbers(const Vec3& p) {
  return {number<Number>(p[0]), number<Number>(p[1]), number<Number>(p[2])};
}

namespace membership {

template <class Number>
Triple<Number> minus(const Triple<Number>& a, const Triple<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class Number>
Triple<Number> cross(const Triple<Number>& u, const Triple<Number>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// Whether x ≥ 0; nullopt where the numbers leave it open, which exact ones never do.
template <class Number>
std::optional<bool> is_not_negative(const Number& x) {
  const std::optional<Sign> sign = sign_of(x);
  return sign ? std::optional(*sign != Sign::Negative) : std::nullopt;
}

/// A ball with its sphere, or without it.
enum class Sphere { With, Without };

/// Whether x ≥ 0 or, without the sphere, x > 0: x says how much nearer than the radius a point is.
template <Sphere kSphere, class Number>
std::optional<bool> is_near_enough(const Number& x) {
  const std::optional<Sign> sign = sign_of(x);
  if (!sign) return std::nullopt;
  return kSphere == Sphere::With ? *sign != Sign::Negative : *sign == Sign::Positive;
}

/// All of them, in turn, until one is false or open.
template <class... Tests>
std::optional<bool> all(const Tests&... tests) {
  std::optional<bool> out = true;
  static_cast<void>(((out = tests(), out == std::optional(true)) && ...));
  return out;
}

template <Sphere kSphere = Sphere::With, class Number>
std::optional<bool> near_point(const Vec3& a, const Triple<Number>& p, double radius) {
  const Triple<Number> w = minus(p, numbers<Number>(a));
  const Number r = number<Number>(radius);
  return is_near_enough<kSphere>(r * r - dot(w, w));
}

/// Of the part of the segment's inside: with d = b − a and w = p − a, 0 ≤ w·d ≤ d·d and
/// |w × d|² ≤ r² d·d.
template <Sphere kSphere = Sphere::With, class Number>
std::optional<bool> near_segment(const Vec3& a, const Vec3& b, const Triple<Number>& p,
                                 double radius) {
  const Triple<Number> d = minus(numbers<Number>(b), numbers<Number>(a)),
                       w = minus(p, numbers<Number>(a));
  const Number along = dot(w, d), square = dot(d, d), r = number<Number>(radius);
  return all([&] { return is_not_negative(along); },
             [&] { return is_not_negative(square - along); },
             [&] {
               const Triple<Number> c = cross(w, d);
               return is_near_enough<kSphere>(r * r * square - dot(c, c));
             });
}

/// Of the prism over the triangle: with n = (b−a)×(c−a), p is on the inner side of the three planes
/// through its sides along n, and (n·(p−a))² ≤ r² n·n.
template <Sphere kSphere = Sphere::With, class Number>
std::optional<bool> near_triangle(const Vec3& a, const Vec3& b, const Vec3& c,
                                  const Triple<Number>& p, double radius) {
  const Triple<Number> na = numbers<Number>(a), nb = numbers<Number>(b), nc = numbers<Number>(c);
  const Triple<Number> n = cross(minus(nb, na), minus(nc, na));
  const auto side = [&](const Triple<Number>& from, const Triple<Number>& to) {
    return is_not_negative(dot(n, cross(minus(to, from), minus(p, from))));
  };
  return all([&] { return side(na, nb); }, [&] { return side(nb, nc); },
             [&] { return side(nc, na); },
             [&] {
               const Number h = dot(n, minus(p, na)), r = number<Number>(radius);
               return is_near_enough<kSphere>(r * r * dot(n, n) - h * h);
             });
}

/// Whether p is not above the plane through the triangle.
template <class Number>
std::optional<bool> is_below(const Vec3& a, const Vec3& b, const Vec3& c, const Triple<Number>& p) {
  const Triple<Number> na = numbers<Number>(a);
  const Triple<Number> n = cross(minus(numbers<Number>(b), na), minus(numbers<Number>(c), na));
  return is_not_negative(dot(n, minus(na, p)));
}

}  // namespace membership

/// Whether a point is in a body: nullopt where the numbers leave it open, which exact ones never
/// do. @pre is_convex(body)
template <class Number>
std::optional<bool> contains_as(const geom::ConvexBody& body, const Triple<Number>& p) {
  const std::vector<Vec3>& v = body.core.vertices;
  const double r = body.radius;
  bool open = false;
  const auto holds = [&](const std::optional<bool>& one) {
    open = open || !one;
    return one.value_or(false);
  };
  if (body.core.triangles.empty()) {
    for (const Vec3& a : v)
      if (holds(membership::near_point(a, p, r))) return true;
    if (v.size() == 2 && holds(membership::near_segment(v[0], v[1], p, r))) return true;
    return open ? std::nullopt : std::optional(false);
  }
  bool inside = true;
  for (const geom::Triangle& t : body.core.triangles) {
    const std::optional<bool> below = membership::is_below(v[t[0]], v[t[1]], v[t[2]], p);
    open = open || !below;
    inside = inside && below == std::optional(true);
    if (below == std::optional(false) && r == 0) return false;
  }
  if (inside) return true;
  if (r > 0) {
    for (const geom::Triangle& t : body.core.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (holds(membership::near_point(v[t[k]], p, r))) return true;
        if (holds(membership::near_segment(v[t[k]], v[t[(k + 1) % 3]], p, r))) return true;
      }
      if (holds(membership::near_triangle(v[t[0]], v[t[1]], v[t[2]], p, r))) return true;
    }
  }
  return open ? std::nullopt : std::optional(false);
}

}  // namespace kaboum::verify
