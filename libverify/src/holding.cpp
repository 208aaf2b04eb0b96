// Whether convex bodies hold balls: a ball of radius r about p is below the plane of a triangle
// with the normal n = (b−a)×(c−a) if h = n·(a−p) ≥ 0 and h² ≥ r² n·n, a sign of dyadic numbers.
#include <kaboum/base/error.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/holding.h>

#include <algorithm>
#include <optional>
#include <string>

#include "number.h"

namespace kaboum::verify {
namespace {

/// nullopt where the numbers leave it open, which exact ones never do.
template <class Number>
std::optional<bool> below(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p,
                          double radius) {
  const Number height = orient3d_value<Number>(a, c, b, p);
  const std::optional<Sign> side = sign_of(height);
  if (!side) return std::nullopt;
  if (*side == Sign::Negative || radius == 0) return *side != Sign::Negative;
  Triple<Number> u, v;
  for (int i = 0; i < 3; ++i) {
    u[static_cast<std::size_t>(i)] = difference<Number>(b[i], a[i]);
    v[static_cast<std::size_t>(i)] = difference<Number>(c[i], a[i]);
  }
  const Triple<Number> normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                              u[0] * v[1] - u[1] * v[0]};
  const Number r = difference<Number>(radius, 0);
  const std::optional<Sign> rest = sign_of(height * height - r * r * dot(normal, normal));
  if (!rest) return std::nullopt;
  return *rest != Sign::Negative;
}

bool holds(const geom::Mesh& hull, const RoundedHull& held) {
  return std::all_of(hull.triangles.begin(), hull.triangles.end(), [&](const geom::Triangle& t) {
    const Vec3 &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
    return std::all_of(held.points.begin(), held.points.end(), [&](const Vec3& p) {
      const std::optional<bool> rounded = below<Approx>(a, b, c, p, held.radius);
      return rounded ? *rounded : *below<Exact>(a, b, c, p, held.radius);
    });
  });
}

}  // namespace

Claim verify_holding(const geom::ConvexSet& set, std::span<const RoundedHull> held) {
  Claim claim = verify_convexity(set).convex;
  if (claim.answer != Answer::Verified) return claim;
  const auto refute = [&](std::string why) {
    claim.answer = Answer::Refuted;
    claim.reason = std::move(why);
    return claim;
  };
  if (set.bodies.size() != held.size())
    return refute(std::to_string(set.bodies.size()) + " bodies for " + std::to_string(held.size()));
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!(held[i].radius >= 0) || !std::isfinite(held[i].radius) ||
        !std::all_of(held[i].points.begin(), held[i].points.end(),
                     [](const Vec3& p) { return p.allFinite(); }))
      throw Error(ErrorCode::InvalidInput,
                  "body " + std::to_string(i) + ": what it is to hold is not finite");
    if (!holds(set.bodies[i].core, held[i]))
      return refute("body " + std::to_string(i) + " (" + set.bodies[i].name +
                    ") does not hold what it is to");
  }
  return claim;
}

}  // namespace kaboum::verify
