// Predicates of sets: Definition 1, with epsilon, margin and errors of places, and inclusion in
// unions.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/collide/inclusion.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "pairs.h"

namespace kaboum::collide {
namespace {

using geom::Vec3;

geom::Mesh box(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> points;
  for (const double x : {low.x(), high.x()})
    for (const double y : {low.y(), high.y()})
      for (const double z : {low.z(), high.z()}) points.emplace_back(x, y, z);
  return *geom::convex_hull(points);
}

BoundingSet set_of(const std::vector<geom::Mesh>& hulls, Direction direction, double epsilon = 0,
                   double margin = 0) {
  std::vector<geom::ConvexBody> bodies;
  for (const geom::Mesh& hull : hulls) bodies.push_back({"", hull, margin});
  return {bodies, direction, epsilon};
}

geom::Transform at(double x, double y = 0, double z = 0) {
  return {Eigen::Matrix3d::Identity(), {x, y, z}};
}

const geom::Mesh kUnit = box({0, 0, 0}, {1, 1, 1});

TEST(FindCollision, MarginsErrorsAndSlackCount) {
  const BoundingSet plain = set_of({kUnit}, Direction::Outer),
                    wide = set_of({kUnit}, Direction::Outer, 0.25, 0.25);
  const auto collide = [](const BoundingSet& a, const BoundingSet& b, double x, double error,
                          double slack) {
    return find_collision(PosedSet(a), PosedSet(b, at(x), error), slack).has_value();
  };
  EXPECT_TRUE(collide(plain, plain, 1, 0, 0));
  EXPECT_FALSE(collide(plain, plain, 1 + 1e-15, 0, 0));
  EXPECT_TRUE(collide(wide, plain, 1.25, 0, 0));
  EXPECT_FALSE(collide(wide, plain, 1.25 + 1e-15, 0, 0));
  EXPECT_TRUE(collide(wide, wide, 1.5, 0, 0));
  EXPECT_FALSE(collide(wide, wide, 1.5 + 1e-12, 0, 0));
  EXPECT_TRUE(collide(plain, plain, 1.125, 0.125, 0));
  EXPECT_FALSE(collide(plain, plain, 1.125 + 1e-12, 0.125, 0));
  EXPECT_TRUE(collide(plain, plain, 1.125, 0, 0.125));
  EXPECT_FALSE(collide(plain, plain, 1.125 + 1e-12, 0, 0.125));
}

TEST(FindCollision, IsTrueForAllCollisionsAndFalseBeyondEpsilon) {
  // Outer sets of balls, the vertices of which are known to be at most epsilon outside.
  std::mt19937_64 random(3);
  int meet = 0, apart = 0, between = 0;
  for (int i = 0; i < 600; ++i) {
    const auto ball = [&](double radius, double epsilon) {
      std::vector<Vec3> points;
      // A cube's corners on the sphere of radius + epsilon, many turned cubes.
      for (int k = 0; k < 40; ++k)
        points.emplace_back((radius + epsilon) * test::random_point(random, 1).normalized());
      return *geom::convex_hull(points);
    };
    const double epsilon = 0.4;
    const BoundingSet a = set_of({ball(1, epsilon)}, Direction::Outer, epsilon),
                      b = set_of({ball(1, epsilon)}, Direction::Outer, epsilon);
    const Vec3 to = test::random_point(random, 2.2);
    // Such a hull holds a ball of the radius only if its facets are far enough: measured.
    double held = 10;
    for (const BoundingSet* s : {&a, &b})
      for (const auto& [p, q, r] : s->body(0).core.triangles) {
        const auto& v = s->body(0).core.vertices;
        held = std::min(held, (v[q] - v[p]).cross(v[r] - v[p]).normalized().dot(v[p]));
      }
    const bool found =
        find_collision(PosedSet(a), PosedSet(b, {test::random_rotation(random), to})).has_value();
    if (to.norm() < 2 * held - 1e-9) {
      EXPECT_TRUE(found);
      ++meet;
    } else if (to.norm() > 2 * (1 + epsilon) + 1e-9) {
      EXPECT_FALSE(found);
      ++apart;
    } else {
      ++between;
    }
  }
  EXPECT_GT(meet, 50);
  EXPECT_GT(apart, 50);
  EXPECT_GT(between, 10);
}

TEST(FindCollision, FindsWhatAllPairsOfBodiesFind) {
  std::mt19937_64 random(4);
  Memory memory;
  int collisions = 0;
  std::vector<geom::Mesh> left, right;
  for (int k = 0; k < 6; ++k) left.push_back(test::random_body(random, 1));
  for (int k = 0; k < 5; ++k) right.push_back(test::random_body(random, 1));
  const BoundingSet a = set_of(left, Direction::Outer, 0.1), b = set_of(right, Direction::Outer);
  for (int i = 0; i < 400; ++i) {
    const geom::Transform pose = test::random_pose(random, 2.5);
    bool expected = false;
    for (const geom::Mesh& x : left)
      for (const geom::Mesh& y : right)
        expected = expected || test::meet(x.vertices, y.vertices, pose);
    const PosedSet there(b, pose);
    EXPECT_EQ(find_collision(PosedSet(a), there, 0, &memory).has_value(), expected) << i;
    const auto c = clearance(PosedSet(a), there);
    ASSERT_TRUE(c);
    EXPECT_EQ(c->lower == 0, expected) << i;
    EXPECT_LE(c->lower, c->upper);
    if (!expected) {
      EXPECT_NEAR((c->on_a - c->on_b).norm(), c->upper, 1e-12);
      EXPECT_FALSE(find_collision(PosedSet(a), there, c->lower * (1 - 1e-12)));
      EXPECT_TRUE(find_collision(PosedSet(a), there, c->upper * (1 + 1e-12)));
    }
    collisions += expected ? 1 : 0;
  }
  EXPECT_GT(collisions, 40);
  EXPECT_LT(collisions, 360);
}

TEST(FindCollision, BoxesLeaveOutNoneThatNearlyTouch) {
  // Bodies with facets along the axes of their frames, facet to facet up to rounding, anywhere:
  // boxes along these axes are as good as the bodies, and must not be better.
  std::mt19937_64 random(8);
  const BoundingSet cube = set_of({kUnit}, Direction::Outer);
  int meet = 0, apart = 0;
  for (int i = 0; i < 4000; ++i) {
    const double away = std::pow(10.0, static_cast<double>(random() % 6) - 2);
    const geom::Transform there{test::random_rotation(random), test::random_point(random, away)};
    // The other one turns about the axis across the facet.
    const double angle = i % 2 == 0 ? 0 : std::uniform_real_distribution<double>(-3, 3)(random);
    const geom::Transform beside =
        there *
        geom::Transform{Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix(), {1, 0, 0}};
    const PosedSet a(cube, there), b(cube, beside);
    const bool touch = are_within(a.body(0), b.body(0), 0);
    EXPECT_EQ(find_collision(a, b).has_value(), touch) << i;
    EXPECT_EQ(find_collision(b, a).has_value(), touch) << i;
    const double slack = std::uniform_real_distribution<double>(0, 1)(random);
    const geom::Transform farther{beside.linear, beside.translation + slack * there.linear.col(0)};
    const PosedSet c(cube, farther);
    EXPECT_EQ(find_collision(a, c, slack).has_value(), are_within(a.body(0), c.body(0), slack))
        << i;
    ++(touch ? meet : apart);
  }
  EXPECT_GT(meet, 500);
  EXPECT_GT(apart, 500);
}

// Balls and capsules: their distance is that of points and segments, less the radii.
TEST(FindCollision, OfPointsAndSegmentsIsExact) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto any = [&] {
    const double x = unit(random), y = unit(random), z = unit(random);
    return geom::Vec3(x, y, z);
  };
  for (int i = 0; i < 300; ++i) {
    const geom::Vec3 a = any(), b = any(), c = any();
    const geom::Vec3 along = b - a;
    const double share = std::clamp((c - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (a + share * along - c).norm(), first = 0.3 * distance;
    for (const double by : {-1e-12, 1e-12}) {
      const double second = distance - first + by;
      const BoundingSet capsule({{"", {{a, b}, {}}, first}}, Direction::Outer, 0.1),
          ball({{"", {{c}, {}}, second}}, Direction::Outer, 0.1),
          inner_capsule({{"", {{a, b}, {}}, first}}, Direction::Inner, 0.1),
          inner_ball({{"", {{c}, {}}, second}}, Direction::Inner, 0.1);
      const PosedSet p(capsule), q(ball);
      EXPECT_EQ(find_collision(p, q).has_value(), by > 0) << i;
      EXPECT_EQ(certainly_collide(PosedSet(inner_capsule), PosedSet(inner_ball)), by > 0) << i;
      const auto gap = clearance(p, q);
      ASSERT_TRUE(gap);
      EXPECT_LE(gap->lower, std::max(0.0, -by) + 1e-13);
      EXPECT_NEAR(gap->upper, std::max(0.0, -by), 1e-13);
      // Where it is may be wrong by more than the overlap: nothing is certain.
      EXPECT_FALSE(certainly_collide(PosedSet(inner_capsule, {}, 1e-9), PosedSet(inner_ball)));
    }
    // An overlap of more than the error is certain.
    const BoundingSet wide({{"", {{a, b}, {}}, distance + 0.1}}, Direction::Inner, 0.1),
        ball({{"", {{c}, {}}, 0.1}}, Direction::Inner, 0.1);
    EXPECT_TRUE(certainly_collide(PosedSet(wide, {}, 0.05), PosedSet(ball, {}, 0.05)));
    EXPECT_FALSE(certainly_collide(PosedSet(wide, {}, 0.15), PosedSet(ball, {}, 0.06)));
  }
}

TEST(FindInclusion, OfAndInBodiesWithARadius) {
  const BoundingSet room({{"", {{{-1, 0, 0}, {1, 0, 0}}, {}}, 1}, {"", {{{3, 0, 0}}, {}}, 1.5}},
                         Direction::Inner, 0);
  const auto in = [&](const geom::ConvexBody& body) {
    const BoundingSet outer({body}, Direction::Outer, 0);
    return find_inclusion(PosedSet(outer), PosedSet(room));
  };
  EXPECT_EQ(in({"", box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})}), Inclusion::Included);
  EXPECT_EQ(in({"", box({-0.5, -0.8, -0.8}, {0.5, 0.8, 0.8})}), Inclusion::NotIncluded);
  EXPECT_EQ(in({"", {{{0, 0, 0}}, {}}, 0.5}), Inclusion::Included);
  EXPECT_EQ(in({"", {{{0, 0, 0}}, {}}, 1.1}), Inclusion::NotIncluded);
  EXPECT_EQ(in({"", {{{-1, 0, 0}, {2, 0, 0}}, {}}, 0.3}), Inclusion::Included);
  EXPECT_EQ(in({"", {{{9, 0, 0}}, {}}, 0.1}), Inclusion::NotIncluded);  // far from all bodies
  const BoundingSet outer({{"", {{{0, 0, 0}}, {}}, 0.5}}, Direction::Outer, 0);
  EXPECT_LT(tolerance_of_inclusion(PosedSet(outer), PosedSet(room)), 1);
}

TEST(FindCollision, SweptAndOtherSetsAreReadAsTheirContainersSay) {
  geom::ConvexSet set{{{"body", kUnit, 0.5}}, {}};
  EXPECT_THROW(BoundingSet{set}, Error);
  set.provenance.direction = "outer";
  EXPECT_THROW(BoundingSet{set}, Error);
  set.provenance.epsilon = 0.75;
  const BoundingSet read(set);
  EXPECT_EQ(read.epsilon(), 0.75);
  EXPECT_EQ(read.body(0).radius, 0.5);
  EXPECT_TRUE(find_collision(PosedSet(read), PosedSet(read, at(2))));
  EXPECT_FALSE(find_collision(PosedSet(read), PosedSet(read, at(2.000001))));
  set.provenance.direction = "inner";
  const BoundingSet inner(set);
  EXPECT_THROW(find_collision(PosedSet(inner), PosedSet(read)), Error);
  set.bodies[0].core.vertices[0] = {0.5, 0.5, 0.5};
  EXPECT_THROW(BoundingSet{set}, Error);
}

TEST(FindCollision, RefusesPosesThatAreNoRotations) {
  const BoundingSet set = set_of({kUnit}, Direction::Outer);
  EXPECT_THROW(PosedSet(set, {2 * Eigen::Matrix3d::Identity(), Vec3::Zero()}), Error);
  EXPECT_THROW(PosedSet(set, {-Eigen::Matrix3d::Identity(), Vec3::Zero()}), Error);
  EXPECT_THROW(PosedSet(set, at(std::nan(""))), Error);
  EXPECT_THROW(PosedSet(set, at(0), -1), Error);
}

/// As far from a rotation as is taken: by less than 1e-9 in LᵀL.
geom::Transform scaled_at(double scale, double x) {
  return {scale * Eigen::Matrix3d::Identity(), {x, 0, 0}};
}

TEST(FindCollision, WhatAMatrixStretchesMarginsByCounts) {
  const BoundingSet plain = set_of({kUnit}, Direction::Outer),
                    wide = set_of({box({0, -1, -1}, {1, 1, 1})}, Direction::Outer, 64, 64);
  const double scale = 1 + 4.9e-10, reach = 64 * scale;
  // The image of the wide one's margin reaches from x down to x - reach.
  EXPECT_TRUE(find_collision(PosedSet(plain), PosedSet(wide, scaled_at(scale, 1 + reach - 1e-9))));
  EXPECT_TRUE(find_collision(PosedSet(wide, scaled_at(scale, 1 + reach - 1e-9)), PosedSet(plain)));
  EXPECT_FALSE(find_collision(PosedSet(plain), PosedSet(wide, scaled_at(scale, 1 + reach + 1e-6))));
  EXPECT_LE(clearance(PosedSet(plain), PosedSet(wide, scaled_at(scale, 1 + reach - 1e-9)))->lower,
            0);
  EXPECT_LE(PosedSet(wide, scaled_at(scale, 0)).box().min.x(), -reach);
}

TEST(CertainlyCollide, OnlyWithWhatAMatrixLeavesOfMargins) {
  const BoundingSet plain = set_of({kUnit}, Direction::Inner),
                    wide = set_of({box({0, -1, -1}, {1, 1, 1})}, Direction::Inner, 0, 64);
  const double scale = 1 - 4.9e-10, reach = 64 * scale;
  EXPECT_FALSE(
      certainly_collide(PosedSet(plain), PosedSet(wide, scaled_at(scale, 1 + reach + 1e-9))));
  EXPECT_TRUE(
      certainly_collide(PosedSet(plain), PosedSet(wide, scaled_at(scale, 1 + reach - 1e-6))));
  EXPECT_GE(clearance(PosedSet(plain), PosedSet(wide, scaled_at(scale, 1 + reach + 1e-9)))->upper,
            0.9e-9);
}

TEST(CertainlyCollide, OnlyWhenInnerSetsMeetHoweverTheyArePlaced) {
  const BoundingSet inner = set_of({kUnit}, Direction::Inner, 0.1),
                    outer = set_of({kUnit}, Direction::Outer, 0.1);
  EXPECT_TRUE(certainly_collide(PosedSet(inner), PosedSet(inner, at(1))));
  EXPECT_FALSE(certainly_collide(PosedSet(inner), PosedSet(inner, at(1 + 1e-15))));
  EXPECT_FALSE(certainly_collide(PosedSet(inner, {}, 0.01), PosedSet(inner, at(1))));
  EXPECT_FALSE(certainly_collide(PosedSet(inner, {}, 0.01), PosedSet(inner, at(0.995))));
  EXPECT_TRUE(certainly_collide(PosedSet(inner, {}, 0.01), PosedSet(inner, at(0.9))));
  EXPECT_THROW(certainly_collide(PosedSet(inner), PosedSet(outer)), Error);
}

TEST(FindCollision, SlackIsALength) {
  const BoundingSet a = set_of({kUnit}, Direction::Outer);
  for (const double slack : {-1e-9, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(find_collision(PosedSet(a), PosedSet(a), slack), Error);
}

/// Balls of radius 1 on a grid of spacing 4, row by row, so that boxes round 64 of them, and round
/// 64 such boxes, are apart.
std::vector<Vec3> grid(std::size_t count) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(4.0 * Vec3(static_cast<double>(i % 64), static_cast<double>(i / 64 % 64),
                             static_cast<double>(i / 4096)));
  return out;
}
BoundingSet balls(const std::vector<Vec3>& centers) {
  std::vector<geom::ConvexBody> bodies;
  for (const Vec3& c : centers) bodies.push_back({"", {{c}, {}}, 1});
  return {bodies, Direction::Outer, 0};
}

/// A ball that touches one of very many from each of six sides is found, and by no other; of none,
/// one, two and three levels of boxes, the last one full or not, and after a move.
TEST(FindCollision, EachOfVeryManyBodiesIsFoundFromEverySide) {
  std::mt19937_64 random(11);
  const BoundingSet ball = balls({Vec3::Zero()});
  for (const std::size_t count : {64U, 65U, 129U, 4096U, 4097U, 4161U, 262'144U, 266'305U}) {
    const std::vector<Vec3> centers = grid(count);
    const BoundingSet set = balls(centers);
    PosedSet many(set);
    const PosedSet kept = many;
    const geom::Transform pose = test::random_pose(random, 50);
    many.place(pose);
    PosedSet one(ball);
    const std::size_t stride = count > 10'000 ? 1021 : 1;
    for (std::size_t i = count - 1, k = 0; i < count; i -= stride, ++k) {
      Vec3 side = Vec3::Zero();
      side[static_cast<int>(k % 3)] = k % 2 == 0 ? 1.9 : -1.9;
      for (const bool moved : {false, true}) {
        const PosedSet& at = moved ? many : kept;
        const Vec3 place = centers[i] + side;
        one.place({Eigen::Matrix3d::Identity(), moved ? pose * place : place});
        const auto found = find_collision(one, at), reverse = find_collision(at, one);
        // The next one on the grid is 0.1 off.
        ASSERT_TRUE(found && reverse) << count << " bodies, body " << i;
        ASSERT_EQ(found->b, i);
        ASSERT_EQ(reverse->a, i);
        // Off the grid, nothing is near.
        const Vec3 off = centers[i] + Vec3::Constant(2);
        one.place({Eigen::Matrix3d::Identity(), moved ? pose * off : off});
        ASSERT_FALSE(find_collision(one, at));
      }
    }
  }
}

/// Two sets of very many bodies, of which one pair meets.
TEST(FindCollision, TheOnePairOfVeryManyIsFound) {
  std::mt19937_64 random(12);
  std::vector<Vec3> centers = grid(4500);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> others = centers;
    for (Vec3& p : others) p += Vec3::Constant(2);  // 2√3 from the nearest ones
    const std::size_t i = random() % centers.size();
    others[i] = centers[i] + Vec3(0, 0, 1.5);
    const BoundingSet a = balls(centers), b = balls(others);
    const auto found = find_collision(PosedSet(a), PosedSet(b));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->a, i);
    EXPECT_EQ(found->b, i);
    others[i] = centers[i] + Vec3::Constant(2);
    EXPECT_FALSE(find_collision(PosedSet(a), PosedSet(balls(others))));
  }
}

TEST(FindCollision, ManyThreadsMayAskOfTheSameSets) {
  std::mt19937_64 random(5);
  const BoundingSet a = set_of({kUnit, box({2, 0, 0}, {3, 1, 1})}, Direction::Outer),
                    b = set_of({kUnit}, Direction::Outer);
  const PosedSet here(a);
  std::vector<geom::Transform> poses;
  std::vector<char> expected;
  for (int i = 0; i < 200; ++i) {
    poses.push_back(test::random_pose(random, 3));
    expected.push_back(find_collision(here, PosedSet(b, poses.back())) ? 1 : 0);
  }
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      Memory memory;
      PosedSet there(b);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        there.place(poses[i]);
        const bool found = find_collision(here, there, 0, &memory).has_value();
        wrong[t] += found == (expected[i] != 0) ? 0 : 1;
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const int w : wrong) EXPECT_EQ(w, 0);
}

TEST(FindInclusion, TheUnionCountsNotTheVertices) {
  // Two walls with a gap between them: all corners of a bar are inside, its middle is not.
  const geom::Mesh bar = box({0.5, 0.25, 0.25}, {2.5, 0.75, 0.75});
  const BoundingSet outer = set_of({bar}, Direction::Outer);
  const auto included = [&](const std::vector<geom::Mesh>& bodies) {
    return find_inclusion(PosedSet(outer), PosedSet(set_of(bodies, Direction::Inner)));
  };
  const geom::Mesh left = box({0, 0, 0}, {1, 1, 1}), right = box({2, 0, 0}, {3, 1, 1});
  EXPECT_EQ(included({left, right}), Inclusion::NotIncluded);
  EXPECT_EQ(included({left, right, box({1, 0, 0}, {2, 1, 1})}), Inclusion::Included);
  EXPECT_EQ(included({left, right, box({1 + 1e-15, 0, 0}, {2, 1, 1})}), Inclusion::NotIncluded);
  EXPECT_EQ(included({left, right, box({1, 0, 0}, {2, 1, 0.5})}), Inclusion::NotIncluded);
  EXPECT_EQ(included({left, right, box({1, 0, 0}, {2, 1, 0.5}), box({1, 0, 0.5}, {2, 0.5, 1}),
                      box({1, 0.5, 0.5}, {2, 1, 1})}),
            Inclusion::Included);
  EXPECT_EQ(included({}), Inclusion::NotIncluded);
}

TEST(FindInclusion, MarginsAndErrorsCount) {
  const BoundingSet region = set_of({box({0, 0, 0}, {4, 4, 4})}, Direction::Inner, 0.1);
  const auto included = [&](double margin, double x, double error, double other) {
    const BoundingSet outer = set_of({kUnit}, Direction::Outer, 0.2, margin);
    return find_inclusion(PosedSet(outer, at(x, 1, 1), error), PosedSet(region, at(0), other));
  };
  EXPECT_EQ(included(0, 3, 0, 0), Inclusion::Included);
  EXPECT_EQ(included(0, 3 + 1e-15, 0, 0), Inclusion::NotIncluded);
  EXPECT_EQ(included(0.125, 2.8, 0, 0), Inclusion::Included);
  EXPECT_EQ(included(0.125, 2.9, 0, 0), Inclusion::NotIncluded);
  EXPECT_EQ(included(0, 2.95, 0.04, 0), Inclusion::Included);
  EXPECT_EQ(included(0, 2.95, 0.06, 0), Inclusion::NotIncluded);
  EXPECT_EQ(included(0, 2.95, 0.03, 0.03), Inclusion::NotIncluded);
  const BoundingSet outer = set_of({kUnit}, Direction::Outer, 0.2, 0.125);
  EXPECT_GE(tolerance_of_inclusion(PosedSet(outer), PosedSet(region)), 0.3 + 0.125 * 1.73);
  EXPECT_THROW(find_inclusion(PosedSet(region), PosedSet(outer)), Error);
}

TEST(FindInclusion, AMatrixThatShrinksLeavesMarginsAndErrorsWhole) {
  const BoundingSet outer = set_of({box({-1, -1, -1}, {1, 1, 1})}, Direction::Outer, 64, 64);
  const double scale = 1 - 4.9e-10;
  for (const double error : {0.0, 64.0}) {
    const double reach = scale * 65 + error;
    const auto included = [&](double half) {
      const BoundingSet region =
          set_of({box(Vec3::Constant(-half), Vec3::Constant(half))}, Direction::Inner);
      return find_inclusion(PosedSet(outer, scaled_at(scale, 0), error), PosedSet(region));
    };
    EXPECT_EQ(included(reach * (1 - 1e-12)), Inclusion::NotIncluded);
    EXPECT_EQ(included(reach * (1 + 2e-4)), Inclusion::Included);
  }
}

TEST(FindInclusion, BodiesThatOnlyEnlargedCornersReachAreNotLeftOut) {
  const BoundingSet outer =
      set_of({box(Vec3::Constant(-0.5), Vec3::Constant(0.5))}, Direction::Outer, 0.5, 0.5);
  const geom::Transform turned{Eigen::AngleAxisd(EIGEN_PI / 4, Vec3::UnitZ()).toRotationMatrix(),
                               Vec3::Zero()};
  const BoundingSet region =
      set_of({box({-3, -3, -3}, {1.25, 3, 3}), box({1.25, -3, -3}, {3, 3, 3})}, Direction::Inner);
  ASSERT_LT(tolerance_of_inclusion(PosedSet(outer), PosedSet(region)), 3 - std::sqrt(0.5));
  EXPECT_EQ(find_inclusion(PosedSet(outer, turned), PosedSet(region)), Inclusion::Included);
}

TEST(FindInclusion, SaysOfTurnedUnionsWhatSamplesSay) {
  std::mt19937_64 random(6);
  int included = 0, outside = 0;
  for (int i = 0; i < 60; ++i) {
    std::vector<geom::Mesh> bodies;
    for (int k = 0; k < 5; ++k) bodies.push_back(test::random_body(random, 0.25));
    const geom::Transform pose = test::random_pose(random, 0.2);
    const geom::Mesh small = [&] {
      geom::Mesh mesh = test::random_body(random, 0.1);
      for (Vec3& v : mesh.vertices) v *= 0.3;
      return mesh;
    }();
    const BoundingSet outer = set_of({small}, Direction::Outer),
                      inner = set_of(bodies, Direction::Inner);
    const Inclusion found = find_inclusion(PosedSet(outer, pose), PosedSet(inner));
    bool all = true;
    for (int k = 0; k < 300; ++k) {
      Vec3 sum = Vec3::Zero();
      double shares = 0;
      for (const Vec3& v : small.vertices) {
        const double share = -std::log(std::uniform_real_distribution<double>(1e-9, 1)(random));
        sum += share * v;
        shares += share;
      }
      const Vec3 p = pose * Vec3(sum / shares);
      bool held = false;
      for (const geom::Mesh& body : bodies) {
        bool below = true;
        for (const auto& [x, y, z] : body.triangles)
          below = below && geom::orient3d(body.vertices[x], body.vertices[y], body.vertices[z],
                                          p) != geom::Sign::Positive;
        held = held || below;
      }
      all = all && held;
    }
    ASSERT_NE(found, Inclusion::Undecided);
    if (found == Inclusion::Included) {
      EXPECT_TRUE(all) << i;
    }
    if (!all) {
      EXPECT_EQ(found, Inclusion::NotIncluded) << i;
    }
    (found == Inclusion::Included ? included : outside) += 1;
  }
  EXPECT_GT(included, 3);
  EXPECT_GT(outside, 10);
}

TEST(FindInclusion, GivesUpWhereWorkEnds) {
  const BoundingSet outer = set_of({kUnit}, Direction::Outer);
  std::vector<geom::Mesh> slabs;
  for (int i = 0; i < 8; ++i) slabs.push_back(box({i / 8.0, -1, -1}, {(i + 1) / 8.0, 2, 2}));
  const BoundingSet inner = set_of(slabs, Direction::Inner);
  EXPECT_EQ(find_inclusion(PosedSet(outer), PosedSet(inner), 3), Inclusion::Undecided);
  EXPECT_EQ(find_inclusion(PosedSet(outer), PosedSet(inner), 100), Inclusion::Included);
}

}  // namespace
}  // namespace kaboum::collide
