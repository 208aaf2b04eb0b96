#pragma once

#include <kaboum/geom/convex_set.h>

#include <vector>

#include "number.h"
#include "rounding.h"

namespace kaboum::verify {

/// A closed ball.
struct Ball {
  Vec3 center;
  double radius;
};

/// Of each body, in order. @pre each is a ball (is_set_of_balls)
inline std::vector<Ball> balls_of(const geom::ConvexSet& set) {
  std::vector<Ball> out;
  out.reserve(set.bodies.size());
  for (const geom::ConvexBody& body : set.bodies)
    out.push_back({body.core.vertices[0], body.radius});
  return out;
}

inline constexpr double kUnderflow = 0x1p-500;  ///< more than what squares lose, as a length

/// Error of a distance between points that were computed from numbers up to `largest` by a dozen
/// roundings. [length]
inline double slack_of(double largest) { return 64 * kUnit * largest + kUnderflow; }

/// Whether a point given by doubles is in a ball, exactly.
inline bool is_within(const Ball& ball, const Vec3& p) {
  const double distance = (p - ball.center).norm(),
               slack = slack_of(p.cwiseAbs().maxCoeff() + ball.center.cwiseAbs().maxCoeff() +
                                ball.radius);
  if (distance + slack <= ball.radius) return true;
  if (distance - slack > ball.radius) return false;
  const Triple<Exact> d{difference<Exact>(p[0], ball.center[0]),
                        difference<Exact>(p[1], ball.center[1]),
                        difference<Exact>(p[2], ball.center[2])};
  const Exact r(ball.radius);
  return sign_of(r * r - dot(d, d)) != Sign::Negative;
}

}  // namespace kaboum::verify
