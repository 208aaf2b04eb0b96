// Polytopes that bound convex bodies from inside and outside, decided exactly.
// docs/algorithms/rounded-bodies.md.
#include "body_bounds.h"

#include <kaboum/geom/body_polytopes.h>
#include <kaboum/verify/holding.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "membership.h"
#include "nearest.h"
#include "number.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kMostVertices = 200'000;  ///< of all polytopes of a level

/// Whether the body holds every vertex: those of a polytope made of the core's are each near one.
bool holds(const geom::ConvexBody& body, const geom::Mesh& polytope) {
  return std::ranges::all_of(polytope.vertices, [&](const Vec3& p) { return contains(body, p); });
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
                                         const geom::SpherePoints& sphere) {
  const geom::ConvexBody smaller = shrunk(body);
  if (smaller.radius == 0) return body.core;  // of a segment or a point: nothing
  geom::Mesh out = geom::inscribed_polytope(smaller, sphere);
  return holds(body, out) ? std::optional(std::move(out)) : std::nullopt;
}

/// The bounds of one body.
struct OneBody {
  geom::Mesh inside, outside;
  double gap = 0;
};

std::optional<OneBody> bounds_of(const geom::ConvexBody& body, const geom::SpherePoints& sphere) {
  if (!geom::is_convex(body)) return std::nullopt;
  if (body.radius == 0) return OneBody{body.core, body.core};
  auto inside = inner_polytope(body, sphere);
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
  const auto rounded = contains_as(body, numbers<Approx>(p));
  return rounded ? *rounded : *contains_as(body, numbers<Exact>(p));
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
      const double share =
          along.squaredNorm() > 0
              ? std::clamp((p - v.front()).dot(along) / along.squaredNorm(), 0., 1.)
              : 0;
      look(v.front() + share * along, body.radius);
    }
    for (const geom::Triangle& t : body.core.triangles)
      look(closest_point(p, v[t[0]], v[t[1]], v[t[2]]), body.radius);
  }
  return std::max(0.0, nearest);
}

std::optional<BodyBounds> bounds_of(const geom::ConvexSet& set, int level) {
  const geom::SpherePoints sphere = geom::sphere_points(level);
  const auto rounded = [](const geom::ConvexBody& body) { return body.radius > 0; };
  const auto many = static_cast<std::size_t>(std::ranges::count_if(set.bodies, rounded));
  if (2 * many * sphere.points.size() > kMostVertices) return std::nullopt;
  std::vector<std::optional<OneBody>> found(set.bodies.size());
  parallel_for(std::size_t{0}, found.size(),
               [&](std::size_t i) { found[i] = bounds_of(set.bodies[i], sphere); });
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
