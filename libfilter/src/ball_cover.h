#pragma once

#include <kaboum/collide/bounding_set.h>

#include <cstddef>
#include <vector>

namespace kaboum::filter::detail {

using geom::Vec3;

struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

/// Balls of a set of convex bodies, in its frame.
struct BallCover {
  std::vector<Ball> outer;          ///< together they hold all bodies, one after the other
  std::vector<std::size_t> bodies;  ///< numbers of each body's first ball, and of all
  std::vector<Ball> inner;          ///< each lies in a body
};

/// Covers of several sets, with at most so many balls together, but for one for each body.
std::vector<BallCover> cover_by_balls(const std::vector<const collide::BoundingSet*>& sets,
                                      std::size_t most);

/// Nearly the smallest ball round points.
Ball ball_round(const std::vector<Vec3>& points);

/// A large ball in a body, about a point or another near it; radius < 0: none was found.
Ball inner_ball(const geom::ConvexBody& body, const Vec3& near);

}  // namespace kaboum::filter::detail
