// Polytopes that bound convex bodies from inside and outside, decided exactly.
// docs/algorithms/rounded-bodies.md.
#include "body_bounds.h"

#include <kaboum/geom/body_polytopes.h>
#include <kaboum/verify/holding.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nearest.h"
#include "number.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kMostVertices = 200'000;  ///< of all polytopes of a level

template <class Number>
Triple<Number> minus(const Vec3& a, const Vec3& b) {
  return {difference<Number>(a[0], b[0]), difference<Number>(a[1], b[1]),
          difference<Number>(a[2], b[2])};
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

/// All of them, in turn, until one is false or open.
template <class... Tests>
std::optional<bool> all(const Tests&... tests) {
  std::optional<bool> out = true;
  static_cast<void>(((out = tests(), out == std::optional(true)) && ...));
  return out;
}

template <class Number>
std::optional<bool> near_point(const Vec3& a, const Vec3& p, double radius) {
  const Triple<Number> w = minus<Number>(p, a);
  const Number r = difference<Number>(radius, 0);
  return is_not_negative(r * r - dot(w, w));
}

/// Of the part of the segment's inside: with d = b − a and w = p − a, 0 ≤ w·d ≤ d·d and
/// |w × d|² ≤ r² d·d.
template <class Number>
std::optional<bool> near_segment(const Vec3& a, const Vec3& b, const Vec3& p, double radius) {
  const Triple<Number> d = minus<Number>(b, a), w = minus<Number>(p, a);
  const Number along = dot(w, d), square = dot(d, d), r = difference<Number>(radius, 0);
  return all([&] { return is_not_negative(along); },
             [&] { return is_not_negative(square - along); },
             [&] {
               const Triple<Number> c = cross(w, d);
               return is_not_negative(r * r * square - dot(c, c));
             });
}

/// Of the prism over the triangle: with n = (b−a)×(c−a), p is on the inner side of the three planes
/// through its sides along n, and (n·(p−a))² ≤ r² n·n.
template <class Number>
std::optional<bool> near_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p,
                                  double radius) {
  const Triple<Number> n = cross(minus<Number>(b, a), minus<Number>(c, a));
  const auto side = [&](const Vec3& from, const Vec3& to) {
    return is_not_negative(dot(n, cross(minus<Number>(to, from), minus<Number>(p, from))));
  };
  return all([&] { return side(a, b); }, [&] { return side(b, c); }, [&] { return side(c, a); },
             [&] {
               const Number h = dot(n, minus<Number>(p, a)), r = difference<Number>(radius, 0);
               return is_not_negative(r * r * dot(n, n) - h * h);
             });
}

bool near_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, double radius) {
  const auto rounded = near_triangle<Approx>(a, b, c, p, radius);
  return rounded ? *rounded : *near_triangle<Exact>(a, b, c, p, radius);
}
bool near_segment(const Vec3& a, const Vec3& b, const Vec3& p, double radius) {
  const auto rounded = near_segment<Approx>(a, b, p, radius);
  return rounded ? *rounded : *near_segment<Exact>(a, b, p, radius);
}
bool near_point(const Vec3& a, const Vec3& p, double radius) {
  const auto rounded = near_point<Approx>(a, p, radius);
  return rounded ? *rounded : *near_point<Exact>(a, p, radius);
}

/// Whether the body holds every vertex: those of a polytope made of the core's are each near one.
bool holds(const geom::ConvexBody& body, const geom::Mesh& polytope) {
  return std::ranges::all_of(polytope.vertices, [&](const Vec3& p) { return contains(body, p); });
}

/// Points of the body that a polytope within it might miss.
std::vector<Vec3> held_by(const geom::ConvexBody& body, std::span<const Vec3> points) {
  const geom::Box3 box = geom::bounding_box(body);
  std::vector<Vec3> out;
  for (const Vec3& p : points)
    if ((p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all() &&
        contains(body, p))
      out.push_back(p);
  return out;
}

/// The body with a radius so much smaller that rounding does not move points out of it.
geom::ConvexBody shrunk(geom::ConvexBody body) {
  double largest = 0;
  for (const Vec3& v : body.core.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  body.radius = std::max(0.0, body.radius * (1 - 0x1p-40) - 0x1p-48 * largest);
  return body;
}

/// A polytope within a body; no triangles where there is none but for rounding.
std::optional<geom::Mesh> inner_polytope(const geom::ConvexBody& body,
                                         const geom::SpherePoints& sphere,
                                         std::span<const Vec3> held) {
  const geom::ConvexBody smaller = shrunk(body);
  if (smaller.radius == 0) return body.core;  // of a segment or a point: nothing
  geom::Mesh out = geom::inscribed_polytope(smaller, sphere, held_by(body, held));
  return holds(body, out) ? std::optional(std::move(out)) : std::nullopt;
}

/// The bounds of one body.
struct OneBody {
  geom::Mesh inside, outside;
  double gap = 0;
};

std::optional<OneBody> bounds_of(const geom::ConvexBody& body, const geom::SpherePoints& sphere,
                                 std::span<const Vec3> held) {
  if (!geom::is_convex(body)) return std::nullopt;
  if (body.radius == 0) return OneBody{body.core, body.core};
  auto inside = inner_polytope(body, sphere, held);
  if (!inside || (!inside->triangles.empty() && !geom::is_convex(*inside))) return std::nullopt;
  OneBody out{*std::move(inside), geom::circumscribed_polytope(body, sphere)};
  const RoundedHull hull{body.core.vertices, body.radius};
  geom::ConvexSet one;
  one.bodies.push_back({body.name, out.outside});
  if (verify_holding(one, {&hull, 1}).answer != Answer::Verified) return std::nullopt;
  double largest = body.radius;
  for (const Vec3& v : body.core.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  out.gap = body.radius * ((1 + 2e-9) / sphere.inner - 1) + 0x1p-46 * largest;
  return out;
}

std::string text_of(const char* reason) {
  return std::string(reason) + " between polytopes inside the bodies and round them";
}

}  // namespace

bool contains(const geom::ConvexBody& body, const Vec3& p) {
  const std::vector<Vec3>& v = body.core.vertices;
  const double r = body.radius;
  if (body.core.triangles.empty())
    return std::ranges::any_of(v, [&](const Vec3& a) { return near_point(a, p, r); }) ||
           (v.size() == 2 && near_segment(v[0], v[1], p, r));
  const auto below = [&](const geom::Triangle& t) {
    return geom::orient3d(v[t[0]], v[t[1]], v[t[2]], p) != Sign::Positive;
  };
  if (r > 0) {
    for (const geom::Triangle& t : body.core.triangles)
      for (const std::uint32_t corner : t)
        if (near_point(v[corner], p, r)) return true;
    for (const geom::Triangle& t : body.core.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (near_segment(v[t[k]], v[t[(k + 1) % 3]], p, r)) return true;
    for (const geom::Triangle& t : body.core.triangles)
      if (near_triangle(v[t[0]], v[t[1]], v[t[2]], p, r)) return true;
  }
  return std::ranges::all_of(body.core.triangles, below);
}

double distance_to_bodies(const geom::ConvexSet& set, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vec3& near, double radius) {
    nearest = std::min(nearest, (p - near).norm() - radius);
  };
  for (const geom::ConvexBody& body : set.bodies) {
    if (contains(body, p)) return 0;
    const std::vector<Vec3>& v = body.core.vertices;
    if (body.core.triangles.empty()) {
      const Vec3 along = v.back() - v.front();
      const double share = along.squaredNorm() > 0
                               ? std::clamp((p - v.front()).dot(along) / along.squaredNorm(), 0., 1.)
                               : 0;
      look(v.front() + share * along, body.radius);
    }
    for (const geom::Triangle& t : body.core.triangles)
      look(closest_point(p, v[t[0]], v[t[1]], v[t[2]]), body.radius);
  }
  return std::max(0.0, nearest);
}

std::optional<BodyBounds> bounds_of(const geom::ConvexSet& set, int level,
                                    std::span<const Vec3> held) {
  const geom::SpherePoints sphere = geom::sphere_points(level);
  const auto rounded = [](const geom::ConvexBody& body) { return body.radius > 0; };
  const auto many = static_cast<std::size_t>(std::ranges::count_if(set.bodies, rounded));
  if (2 * many * sphere.points.size() > kMostVertices) return std::nullopt;
  std::vector<std::optional<OneBody>> found(set.bodies.size());
  parallel_for(std::size_t{0}, found.size(),
               [&](std::size_t i) { found[i] = bounds_of(set.bodies[i], sphere, held); });
  BodyBounds out;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) return std::nullopt;
    const std::string& name = set.bodies[i].name;
    if (!found[i]->inside.triangles.empty())
      out.inside.bodies.push_back({name, std::move(found[i]->inside)});
    out.outside.bodies.push_back({name, std::move(found[i]->outside)});
    out.gap = std::max(out.gap, found[i]->gap);
  }
  return out;
}

Claim between(Claim sufficient, Claim necessary) {
  if (sufficient.answer == Answer::Verified || sufficient.answer == Answer::Undefined)
    return sufficient;
  necessary.outer_triangles.clear();  // the polytopes'
  if (necessary.answer == Answer::Refuted) return necessary;
  Claim open;
  open.answer = Answer::Undecided;
  open.reason = text_of("the answer lies");
  return open;
}

DistanceClaim between(DistanceClaim sufficient, DistanceClaim necessary) {
  if (sufficient.answer == Answer::Verified || sufficient.answer == Answer::Undefined)
    return sufficient;
  if (necessary.answer == Answer::Refuted) return necessary;
  DistanceClaim open = std::move(necessary);
  open.answer = Answer::Undecided;
  open.reason = text_of("the answer lies");
  return open;
}

Inclusion between(Inclusion sufficient, Inclusion necessary) {
  Inclusion out = std::move(necessary);
  out.solid = between(std::move(sufficient.solid), std::move(out.solid));
  out.surface = between(std::move(sufficient.surface), std::move(out.surface));
  return out;
}

SweepClaims between(SweepClaims sufficient, SweepClaims necessary) {
  SweepClaims out = sufficient.surface.answer == Answer::Verified ? sufficient : necessary;
  out.surface = between(std::move(sufficient.surface), std::move(necessary.surface));
  out.solid = between(std::move(sufficient.solid), std::move(necessary.solid));
  return out;
}

}  // namespace kaboum::verify
