// Covers by balls: their number where it is known, and what they promise.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/balls.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/verify/ball_cover.h>
#include <kaboum/verify/cover.h>
#include <tbb/global_control.h>

#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using geom::Vec3;
using verify::Answer;

CoverCandidate balls_of(const Mesh& mesh, const BallOptions& options) {
  return find_balls(geom::prepare(mesh).solid, options);
}

BallOptions within(double epsilon) {
  BallOptions out;
  out.epsilon = epsilon;
  out.effort = Effort::Fast;
  return out;
}

void expect_held(const Mesh& mesh, const CoverCandidate& found) {
  const geom::ConvexSet set{found.bodies, {}};
  const verify::Inclusion held = verify::verify_ball_cover(mesh, set);
  EXPECT_EQ(held.surface.answer, Answer::Verified) << held.surface.reason;
  EXPECT_EQ(held.solid.answer, Answer::Verified) << held.solid.reason;
  EXPECT_EQ(verify::verify_excess(set, mesh, found.excess_upper * (1 + 1e-6), true).answer,
            Answer::Verified);
  for (const geom::ConvexBody& body : found.bodies) {
    EXPECT_TRUE(geom::is_float32(body.core.vertices[0]));
    EXPECT_TRUE(geom::is_float32(body.radius));
  }
}

// A cylinder of radius 1 within ε: balls of radius 1 + ε, on the axis √((1 + ε)² − 1) from what
// they hold at its side.
TEST(Balls, ACylinderTakesAsManyAsItsLengthSays) {
  const Mesh rod = kaboum::test::cylinder(48, 12, 1, 1);
  const CoverCandidate found = balls_of(rod, within(1));
  expect_held(rod, found);
  EXPECT_GE(found.bodies.size(), 4U);  // 12 / (2 √3) = 3.46
  EXPECT_LE(found.bodies.size(), 5U);
}

// A wall inside does not make them more.
TEST(Balls, WallsInsideCostNothing) {
  const Mesh whole = kaboum::test::box({3, 1, 1}, 1);
  const Mesh parts =
      kaboum::test::merged({kaboum::test::box({2, 1, 1}, 1),
                            kaboum::test::translated(kaboum::test::box({2, 1, 1}, 1), {1, 0, 0})});
  const CoverCandidate one = balls_of(whole, within(0.35)), other = balls_of(parts, within(0.35));
  expect_held(whole, one);
  expect_held(parts, other);
  EXPECT_LE(other.bodies.size(), one.bodies.size() + 1);
}

// The wall of a thick solid takes small balls; its inside has to be held as well.
TEST(Balls, TheInsideIsHeldToo) {
  const Mesh ball = kaboum::test::icosphere(3);
  const CoverCandidate found = balls_of(ball, within(0.05));
  expect_held(ball, found);
}

// Each triangle takes dozens of small balls.
TEST(Balls, FewLargeTrianglesAreHeldByManyBalls) {
  const Mesh bar = kaboum::test::box({4, 1, 1}, 1);
  expect_held(bar, balls_of(bar, within(0.08)));
}

TEST(Balls, ANumberIsKept) {
  const Mesh bar = kaboum::test::box({4, 1, 1}, 1);
  for (const std::size_t count : {1U, 2U, 4U}) {
    BallOptions options;
    options.max_bodies = count;
    options.effort = Effort::Fast;
    const CoverCandidate found = balls_of(bar, options);
    EXPECT_LE(found.bodies.size(), count);
    expect_held(bar, found);
    // n balls on the axis: each holds 4 / n of it.
    const double half = 2.0 / static_cast<double>(count);
    const double known = std::sqrt(half * half + 0.5) - 0.5;
    EXPECT_LE(found.excess_upper, known * 1.05) << count;
  }
}

// Beyond that the search ends, and what is found within it is the same.
TEST(Balls, MoreThanAllowedAreNotSearchedFor) {
  const Mesh bar = kaboum::test::box({4, 1, 1}, 1);
  BallOptions options = within(0.1);
  const CoverCandidate all = balls_of(bar, options);
  options.most = all.bodies.size() - 1;
  try {
    balls_of(bar, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::LimitReached);
  }
  options.most = 200;
  EXPECT_EQ(balls_of(bar, options).bodies.size(), all.bodies.size());
}

TEST(Balls, BallsToBeginWithHoldWhatTheyDidNot) {
  const Mesh bar = kaboum::test::box({4, 1, 1}, 1);
  BallOptions options = within(0.3);
  const CoverCandidate before = balls_of(bar, options);
  for (std::size_t i = 1; i < before.bodies.size(); ++i)
    options.start.push_back({before.bodies[i].core.vertices[0], before.bodies[i].radius});
  options.held = {{2, 0.5, 0.5}};
  expect_held(bar, balls_of(bar, options));
  options.max_bodies = 3;
  EXPECT_THROW(balls_of(bar, options), Error);
}

TEST(Balls, SameForAnyNumberOfThreads) {
  const Mesh torus = kaboum::test::torus(1, 0.3, 24, 12);
  const CoverCandidate all = balls_of(torus, within(0.1));
  const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
  const CoverCandidate one = balls_of(torus, within(0.1));
  ASSERT_EQ(all.bodies.size(), one.bodies.size());
  for (std::size_t i = 0; i < all.bodies.size(); ++i) {
    EXPECT_EQ(all.bodies[i].core.vertices[0], one.bodies[i].core.vertices[0]);
    EXPECT_EQ(all.bodies[i].radius, one.bodies[i].radius);
  }
}

// Changed as little as suffices: what holds stays, one that is left out or too small is made up for
// by its neighbours or by one other, and what reaches too far does so no more.
TEST(Balls, RepairedOnesKeepWhatHolds) {
  const Mesh bar = kaboum::test::box({4, 1, 1}, 1);
  const geom::SolidMesh solid = geom::prepare(bar).solid;
  std::vector<Ball> given;
  for (const geom::ConvexBody& body : balls_of(bar, within(0.4)).bodies)
    given.push_back({body.core.vertices[0], body.radius});
  ASSERT_GE(given.size(), 3U);
  const auto repaired = [&](const std::vector<Ball>& balls) {
    std::vector<Ball> out = repair_balls(solid, balls, {}, within(0.42));
    CoverCandidate found;
    for (const Ball& ball : out) {
      geom::ConvexBody body;
      body.core.vertices = {ball.center};
      body.radius = ball.radius;
      found.bodies.push_back(body);
    }
    const geom::ConvexSet set{found.bodies, {}};
    EXPECT_EQ(verify::verify_ball_cover(bar, set).solid.answer, Answer::Verified);
    EXPECT_EQ(verify::verify_excess(set, bar, 0.42, true).answer, Answer::Verified);
    return out;
  };
  const auto unchanged = [](const std::vector<Ball>& was, const std::vector<Ball>& is) {
    std::size_t out = 0;
    for (std::size_t i = 0; i < was.size(); ++i)
      out += was[i].center == is[i].center && was[i].radius == is[i].radius ? 1 : 0;
    return out;
  };
  EXPECT_EQ(unchanged(given, repaired(given)), given.size());
  EXPECT_EQ(repaired(given).size(), given.size());
  std::vector<Ball> less = given;
  less[0].radius *= 0.6;
  EXPECT_GE(unchanged(given, repaired(less)) + 1, given.size() - 1);
  EXPECT_LE(repaired(less).size(), given.size() + 1);
  less.erase(less.begin());
  EXPECT_GE(unchanged(less, repaired(less)) + 2, less.size());  // its neighbours may change
  EXPECT_LE(repaired(less).size(), given.size() + 2);  // three in place of the one at an end
  std::vector<Ball> far = given;
  far[0].radius *= 5;
  far.push_back({{50, 0, 0}, 1});
  EXPECT_LE(repaired(far)[0].radius, 1.1);
  EXPECT_EQ(repaired(far).size(), far.size());
  EXPECT_FALSE(repaired({}).empty());
  EXPECT_THROW(repair_balls(solid, given, {}, {}), Error);
}

}  // namespace
}  // namespace kaboum::bcd
