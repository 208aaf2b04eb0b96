// Balls inside solids: radii one ulp round the largest, against rational numbers; voids, walls
// inside and tips of the outside; depths that are known.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/polygon2.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/inner_balls.h>
#include <kaboum/verify/mesh_verdict.h>

#include <cmath>
#include <random>

#include "support/ball_oracle.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::verify {
namespace inner_balls_test {
namespace {

using geom::ConvexSet;
using geom::Mesh;
using geom::Vec3;

ConvexSet set_of(const Vec3& center, double radius) {
  ConvexSet out;
  out.bodies.push_back({"ball", {{center}, {}}, radius});
  return out;
}

Claim within(const Mesh& mesh, const ConvexSet& set) {
  const Inclusion found = verify_within(set, mesh);
  EXPECT_EQ(found.solid.answer, found.surface.answer);
  return found.solid;
}
Answer within(const Mesh& mesh, const Vec3& center, double radius) {
  return within(mesh, set_of(center, radius)).answer;
}

bool is_in_a_ball(const ConvexSet& set, const Vec3& p) {
  for (const geom::ConvexBody& body : set.bodies)
    if (test::is_in_ball(body.core.vertices[0], body.radius, p)) return true;
  return false;
}

/// A box from `low` to `high`.
Mesh box_of(const Vec3& low, const Vec3& high) {
  return test::translated(test::box(high - low, 1), low);
}

Mesh l_shape() {
  // Two boxes that share a face: it is there twice, once each way, and bounds nothing.
  return test::merged({box_of({0, 0, 0}, {3, 1, 1}), box_of({0, 1, 0}, {1, 3, 1})});
}

/// A box with a void that has a box in it.
Mesh nested() {
  return test::merged({box_of({0, 0, 0}, {4, 4, 4}), test::flipped(box_of({1, 1, 1}, {3, 3, 3})),
                       box_of({1.5, 1.5, 1.5}, {2.5, 2.5, 2.5})});
}

struct Solid {
  const char* name;
  Mesh mesh;
};

/// Each of their triangles has the solid on one side.
std::vector<Solid> solids() {
  return {{"cube", test::box({1, 1, 1}, 1)},
          {"rotated", test::rotated(test::box({1, 2, 0.5}, 2), 0.7)},
          {"torus", test::torus(1, 0.4, 12, 7)},
          {"nested", nested()},
          {"noisy", test::noisy(test::icosphere(1), 0.2, 3)},
          {"far", test::translated(test::icosphere(1), {1234.5678, -9876.54321, 4321.0987})}};
}

// Radii round the distance of the nearest triangle, ulp by ulp.
TEST(InnerBalls, OneUlpDecides) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const geom::Box3 box = geom::bounding_box(solid.mesh);
    const geom::DistanceQuery query(solid.mesh);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    int fits = 0, sticks_out = 0;
    for (int i = 0; i < 90; ++i) {
      const Vec3 center =
          box.min +
          (box.max - box.min).cwiseProduct(Vec3(unit(random), unit(random), unit(random)));
      const auto distance = query.nearest(center);
      double radius = 0.5 * (distance.lower + distance.upper);
      for (int k = 0; k < 3; ++k) radius = std::nextafter(radius, 0);
      for (int k = 0; k < 7; ++k, radius = std::nextafter(radius, 1e9)) {
        const bool fit = test::is_ball_in_solid(solid.mesh, center, radius);
        const Claim found = within(solid.mesh, set_of(center, radius));
        EXPECT_EQ(found.answer, fit ? Answer::Verified : Answer::Refuted)
            << center.transpose() << ", " << radius;
        if (test::winding_number_slow(solid.mesh, center).value_or(0) >= 1)
          (fit ? fits : sticks_out) += 1;
        if (fit || !found.witness || !found.witness->exact) continue;
        EXPECT_TRUE(test::is_in_ball(center, radius, found.witness->point));
        EXPECT_LE(test::winding_number_slow(solid.mesh, found.witness->point).value_or(1), 0);
      }
    }
    EXPECT_GT(fits, 20);
    EXPECT_GE(sticks_out, 8);
  }
}

TEST(InnerBalls, ABallThatTouchesIsInside) {
  const Mesh cube = test::box({1, 1, 1}, 1);
  const Vec3 middle(0.5, 0.5, 0.5);
  EXPECT_EQ(within(cube, middle, 0.5), Answer::Verified);
  const Claim larger = within(cube, set_of(middle, std::nextafter(0.5, 1)));
  EXPECT_EQ(larger.answer, Answer::Refuted);
  EXPECT_EQ(within(cube, middle, 0.5001), Answer::Refuted);
  // At a corner of a void, and at an edge: 3² + 4² = 5².
  const Mesh hollow =
      test::merged({box_of({-9, -9, -9}, {9, 9, 9}), test::flipped(box_of({3, 4, -1}, {4, 5, 1}))});
  EXPECT_EQ(within(hollow, {0, 0, 0}, 5), Answer::Verified);
  EXPECT_EQ(within(hollow, {0, 0, 0}, std::nextafter(5, 6)), Answer::Refuted);
}

TEST(InnerBalls, ARadiusOfZeroIsNoBall) {
  const Mesh cube = test::box({1, 1, 1}, 1);
  for (const double radius : {0.0, -0.1, std::nan("")}) {
    ConvexSet set = set_of({0.5, 0.5, 0.5}, 0.25);
    set.bodies.push_back(set_of({0.5, 0.5, 0.5}, radius).bodies[0]);
    EXPECT_EQ(verify_convexity(set).convex.answer, Answer::Refuted) << radius;
    EXPECT_NE(verify_within(set, cube).solid.answer, Answer::Verified) << radius;
    EXPECT_NE(verify_depth(cube, set, 0.4).answer, Answer::Verified) << radius;
    const Mesh none;
    const MeshQuestion question{
        .original = cube, .approximation = none, .set = &set, .relation = Relation::Inner};
    EXPECT_EQ(decide(question).answer, Answer::Refuted) << radius;
  }
}

TEST(InnerBalls, CentersAreFinite) {
  const ConvexSet nowhere = set_of({0, 0, std::nan("")}, 1);
  EXPECT_THROW(verify_within(nowhere, l_shape()), Error);
}

/// The ball reaches into the acute groove between two prisms that cross. Its nearest point there is
/// the groove's bottom, next to which all is inside.
TEST(InnerBalls, WitnessesAreOutside) {
  const auto prism = [](const std::vector<geom::Vec2>& corners) {
    std::vector<Vec3> points;
    for (const geom::Vec2& p : corners)
      for (const double z : {0, 4}) points.emplace_back(p.x(), p.y(), z);
    return *geom::convex_hull(points);
  };
  const Mesh grooved = test::merged(
      {prism({{-2, -3}, {4, -3}, {4, 0}, {-2, 0}}), prism({{-2, -1.125}, {4, 0.75}, {-2, 4}})});
  const Claim claim = within(grooved, set_of({1.25, 0.125, 2}, 0.75));
  ASSERT_EQ(claim.answer, Answer::Refuted);
  ASSERT_TRUE(claim.witness && claim.witness->exact);
  EXPECT_LE(test::winding_number_slow(grooved, claim.witness->point).value(), 0);
}

TEST(InnerBalls, VoidsAndTheOutsideAreNoPart) {
  const Mesh mesh = nested();
  EXPECT_EQ(within(mesh, {2, 2, 2}, 0.5), Answer::Verified);     // the box in the void
  EXPECT_EQ(within(mesh, {2, 2, 2}, 0.6), Answer::Refuted);      // into the void
  EXPECT_EQ(within(mesh, {1.25, 2, 2}, 0.25), Answer::Refuted);  // in the void
  EXPECT_EQ(within(mesh, {0.5, 2, 2}, 0.5), Answer::Verified);   // touches both walls
  EXPECT_EQ(within(mesh, {2, 2, 2}, 3), Answer::Refuted);
  EXPECT_EQ(within(mesh, {9, 2, 2}, 1), Answer::Refuted);
  EXPECT_EQ(within(mesh, {1e300, 2, 2}, 1), Answer::Refuted);
  EXPECT_EQ(within(test::flipped(test::box({1, 1, 1}, 1)), {0.5, 0.5, 0.5}, 0.25),
            Answer::Refuted);  // w = -1
  Mesh open = test::box({1, 1, 1}, 1);
  open.triangles.pop_back();
  EXPECT_EQ(within(open, {0.5, 0.5, 0.5}, 0.25), Answer::Undefined);
}

// Walls inside bound nothing, whether the solid winds once or twice beside them.
TEST(InnerBalls, WallsInsideAreNoObstacle) {
  const Mesh two = test::merged({box_of({0, 0, 0}, {2, 1, 1}), box_of({1, 0, 0}, {3, 1, 1})});
  EXPECT_EQ(within(two, {1.5, 0.5, 0.5}, 0.5), Answer::Verified);
  EXPECT_EQ(within(two, {1, 0.5, 0.5}, 0.5), Answer::Verified);  // its centre is on a wall
  EXPECT_EQ(within(two, {1, 0.5, 0.5}, std::nextafter(0.5, 1)), Answer::Refuted);
  EXPECT_EQ(within(l_shape(), {0.5, 1, 0.5}, 0.4999), Answer::Verified);
  // Touches where the shared wall ends, whose place is rounded: never refuted.
  EXPECT_NE(within(l_shape(), {0.5, 1, 0.5}, 0.5), Answer::Refuted);
  EXPECT_EQ(within(l_shape(), {0.75, 0.75, 0.5}, 0.5), Answer::Refuted);
}

// Boxes that cross: of their triangles parts bound the union. What is verified has no point
// outside, what is refuted with an exact witness has that one.
TEST(InnerBalls, OfSolidsThatCrossThemselves) {
  const Mesh first = test::translated(test::box({2, 1, 1}, 1), {-1, -0.5, -0.5});
  const Mesh mesh = test::merged({first, test::rotated(first, 1.1), test::rotated(first, 2.3)});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-1, 1), size(0.05, 0.6);
  std::normal_distribution<double> normal;
  int verified = 0, refuted = 0;
  for (int i = 0; i < 150; ++i) {
    const Vec3 center(at(random), 0.5 * at(random), 0.5 * at(random));
    const double radius = size(random);
    const Claim found = within(mesh, set_of(center, radius));
    if (found.answer == Answer::Verified) {
      ++verified;
      for (int k = 0; k < 60; ++k) {
        const Vec3 d = Vec3(normal(random), normal(random), normal(random)).normalized();
        const Vec3 p = center + (k % 3 == 0 ? 0.9 : 0.99999) * radius * d;
        EXPECT_GE(test::winding_number_slow(mesh, p).value_or(1), 1);
      }
    } else if (found.answer == Answer::Refuted) {
      ++refuted;
      ASSERT_TRUE(found.witness);
      if (!found.witness->exact) continue;
      EXPECT_TRUE(test::is_in_ball(center, radius, found.witness->point));
      EXPECT_LE(test::winding_number_slow(mesh, found.witness->point).value_or(1), 0);
    } else {
      ADD_FAILURE() << found.reason;
    }
  }
  EXPECT_GT(verified, 20);
  EXPECT_GT(refuted, 20);
}

// In a unit cube the ball of radius 1/2 leaves out the corners: (t, t, t) with √3 (1/2 − t) > 1/2.
TEST(InnerBallDepth, OfOneBallInACubeIsKnown) {
  const Mesh cube = test::box({1, 1, 1}, 1);
  const ConvexSet set = set_of({0.5, 0.5, 0.5}, 0.5);
  const double depth = 0.5 - 0.5 / std::sqrt(3);
  EXPECT_EQ(verify_depth(cube, set, depth * 1.0001).answer, Answer::Verified);
  EXPECT_EQ(verify_depth(cube, set, 0.49).answer, Answer::Verified);
  for (const double share : {0.9999, 0.9, 0.5, 0.01}) {
    const Claim claim = verify_depth(cube, set, depth * share);
    ASSERT_EQ(claim.answer, Answer::Refuted) << share;
    EXPECT_FALSE(is_in_a_ball(set, claim.witness->point));
    EXPECT_EQ(test::winding_number_slow(cube, claim.witness->point), 1);
    EXPECT_GT(test::compare_distance(cube, claim.witness->point, depth * share), 0);
    EXPECT_GT(claim.witness->depth, 0);
  }
}

TEST(InnerBallDepth, CountsFromVoidsAndNotFromWallsInside) {
  // Of the void's wall the middle between the walls, at 1/2, is the deepest place; no ball is
  // there.
  const Mesh mesh = nested();
  ConvexSet set = set_of({2, 2, 2}, 0.5);
  EXPECT_EQ(verify_depth(mesh, set, 0.45).answer, Answer::Refuted);
  EXPECT_EQ(verify_depth(mesh, set, 0.75).answer, Answer::Verified);  // √½ in the edges
  ConvexSet row, one_less;
  for (int i = 0; i <= 16; ++i)
    row.bodies.push_back(set_of({0.5 + i / 8.0, 0.5, 0.5}, 0.5).bodies[0]);
  one_less = row;
  one_less.bodies.erase(one_less.bodies.begin() + 4, one_less.bodies.begin() + 13);
  const Mesh bar = box_of({0, 0, 0}, {3, 1, 1});
  const Mesh two = test::merged({box_of({0, 0, 0}, {2, 1, 1}), box_of({1, 0, 0}, {3, 1, 1})});
  int verified = 0, refuted = 0;
  for (const ConvexSet* balls : {&row, &one_less})
    for (const double epsilon : {0.1, 0.15, 0.2, 0.25, 0.3, 0.45, 0.55}) {
      const Answer one = verify_depth(bar, *balls, epsilon).answer;
      EXPECT_EQ(one, verify_depth(two, *balls, epsilon).answer) << epsilon;
      (one == Answer::Verified ? verified : refuted) += 1;
      EXPECT_NE(one, Answer::Undecided);
    }
  EXPECT_GT(verified, 3);
  EXPECT_GT(refuted, 3);
}

// Random balls: no point that is deeper, by rational numbers, is in none.
TEST(InnerBallDepth, AgreesWithPoints) {
  const Mesh torus = test::torus(1, 0.4, 12, 7);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  int verified = 0, refuted = 0;
  for (int round = 0; round < 8; ++round) {
    ConvexSet set;
    const int count = 4 + 6 * round;
    for (int i = 0; i < count; ++i) {
      const double angle = 6.2831853 * i / count;
      set.bodies.push_back(
          set_of({std::cos(angle), std::sin(angle), 0}, 0.25 + 0.1 * unit(random)).bodies[0]);
    }
    const double epsilon = 0.12 + 0.15 * unit(random);
    const Claim claim = verify_depth(torus, set, epsilon);
    (claim.answer == Answer::Verified ? verified : refuted) += 1;
    if (claim.answer == Answer::Refuted) {
      EXPECT_FALSE(is_in_a_ball(set, claim.witness->point));
      EXPECT_EQ(test::winding_number_slow(torus, claim.witness->point), 1);
      EXPECT_GT(test::compare_distance(torus, claim.witness->point, epsilon), 0);
      continue;
    }
    ASSERT_EQ(claim.answer, Answer::Verified) << claim.reason;
    int deep = 0;
    for (int k = 0; k < 300; ++k) {
      const double angle = 6.2831853 * unit(random), out = 1 + 0.8 * (unit(random) - 0.5);
      const Vec3 p(out * std::cos(angle), out * std::sin(angle), 0.8 * (unit(random) - 0.5));
      if (is_in_a_ball(set, p) || test::winding_number_slow(torus, p).value_or(0) < 1) continue;
      ++deep;
      EXPECT_LE(test::compare_distance(torus, p, epsilon), 0) << p.transpose();
    }
    EXPECT_GT(deep, 3);
  }
  EXPECT_GT(verified, 2);
  EXPECT_GT(refuted, 2);
}

// The same at any scale that is a power of two.
TEST(InnerBalls, AtAnyScale) {
  for (const int exponent : {-400, -60, 60, 300}) {
    const double s = std::ldexp(1.0, exponent);
    const Mesh cube = test::scaled(test::box({1, 1, 1}, 1), Vec3::Constant(s));
    const Vec3 middle = Vec3::Constant(0.5 * s);
    EXPECT_EQ(within(cube, middle, 0.5 * s), Answer::Verified) << exponent;
    EXPECT_EQ(within(cube, middle, std::nextafter(0.5, 1) * s), Answer::Refuted) << exponent;
    EXPECT_EQ(verify_depth(cube, set_of(middle, 0.5 * s), 0.22 * s).answer, Answer::Verified);
    EXPECT_EQ(verify_depth(cube, set_of(middle, 0.5 * s), 0.2 * s).answer, Answer::Refuted);
  }
}

}  // namespace
}  // namespace inner_balls_test
}  // namespace kaboum::verify
