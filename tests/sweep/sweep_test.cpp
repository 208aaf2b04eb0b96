#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <tbb/global_control.h>

#include "sampling.h"

namespace kaboum::test {
namespace {

SweepResult make(const TestRobot& r, const Path& path, double epsilon,
                 StepRule rule = StepRule::Balanced) {
  SweepOptions options;
  options.epsilon = epsilon;
  options.rule = rule;
  return swept_volume(r.robot, r.bodies, path, options);
}

TEST(Sweep, NoSampledPointIsMissed) {
  std::mt19937_64 random(31);
  std::size_t tested = 0;
  for (const TestRobot& r : test_robots()) {
    for (int motion = 0; motion < 12; ++motion) {
      const Path path = random_path(r.robot, random, 2 + motion % 3, 2, motion % 2 == 0);
      const StepRule rule = motion % 4 == 3 ? StepRule::Adaptive : StepRule::Balanced;
      const SweepResult result = make(r, path, motion % 3 == 0 ? 0.02 : 0.003, rule);
      EXPECT_LE(margin_of(result.set).value(), motion % 3 == 0 ? 0.02 : 0.003);
      const Missed missed = sample_points(r, path, result, random, 1500);
      EXPECT_EQ(missed.missed, 0U) << r.name << ", motion " << motion;
      tested += missed.tested;
      if (motion < 2) {
        EXPECT_EQ(find_bad_hull(r, result), std::nullopt) << r.name;
      }
    }
  }
  EXPECT_GT(tested, 30000U);
}

TEST(Sweep, ASetWhoseMarginIsCutMissesPoints) {
  std::mt19937_64 random(32);
  for (const TestRobot& r : {six_axis_arm(), prismatic_chain()}) {
    const Path path = random_path(r.robot, random, 2, 1.5, false);
    for (const StepRule rule : {StepRule::Adaptive, StepRule::Balanced}) {
      SweepResult result = make(r, path, 0.005, rule);
      const Missed first = sample_points(r, path, result, random, 3000, true);
      EXPECT_EQ(first.missed, 0U);
      set_margin(result.set, 0.9 * first.largest);
      EXPECT_GT(sample_points(r, path, result, random, 3000, true).missed, 0U) << r.name;
    }
  }
}

TEST(Sweep, AWrongStepIsFoundBySampling) {
  // A piece's hull is replaced by that of its first pose only: points of the other end are missed.
  std::mt19937_64 random(33);
  const TestRobot r = six_axis_arm();
  const Path path = random_path(r.robot, random, 2, 1.5, false);
  SweepResult result = make(r, path, 0.005);
  for (std::size_t i = 0; i < result.pieces.size(); ++i) {
    std::vector<Vec3> points;
    result.pieces[i].finish = result.pieces[i].start;
    for (const Vec3& p : r.bodies[result.sources[i]].points)
      points.emplace_back(result.pieces[i].start * p);
    result.set.bodies[i].core = *geom::convex_hull(points);
  }
  EXPECT_GT(sample_points(r, path, result, random, 2000).missed, 0U);
}

TEST(Sweep, ExplicitMarginContainsTheSum) {
  std::mt19937_64 random(34);
  for (const TestRobot& r : {six_axis_arm(), prismatic_chain()}) {
    const Path path = random_path(r.robot, random, 2, 1, false);
    SweepOptions options;
    options.epsilon = 0.01;
    const SweepResult implicit = swept_volume(r.robot, r.bodies, path, options);
    options.explicit_margin = true;
    const SweepResult result = swept_volume(r.robot, r.bodies, path, options);
    EXPECT_EQ(margin_of(result.set).value(), 0);
    ASSERT_EQ(result.pieces.size(), implicit.pieces.size());
    EXPECT_EQ(geom::find_not_convex(result.set), std::nullopt);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < result.pieces.size(); ++i) {
      const double radius = implicit.pieces[i].deviation;
      for (int k = 0; k < 40; ++k) {
        const auto& vertices = implicit.set.bodies[i].core.vertices;
        const Vec3 d = Vec3(normal(random), normal(random), normal(random)).normalized();
        const Vec3 p = vertices[random() % vertices.size()] + radius * d;
        EXPECT_EQ(distance_to(result.set.bodies[i].core, p), 0);
      }
    }
    EXPECT_EQ(sample_points(r, path, result, random, 3000, true).missed, 0U);
    EXPECT_LE(result.excess, implicit.excess + 0.01);
  }
}

TEST(Sweep, SimplifiedHullsHaveFewerVerticesAndMissNothing) {
  std::mt19937_64 random(37);
  for (TestRobot r : {six_axis_arm(), prismatic_chain()}) {
    for (LinkBody& body : r.bodies) {  // round ones, of 162 corners
      Geometry ball;
      ball.shape = Geometry::Shape::Sphere;
      ball.size.x() = 0.06;
      ball.origin.translation = body.points.front();
      body.points = bounding_points(ball);
    }
    const Path path = random_path(r.robot, random, 2, 1, false);
    const auto vertices = [](const SweepResult& result) {  // of a body, on average
      double sum = 0;
      for (const auto& body : result.set.bodies)
        sum += static_cast<double>(body.core.vertices.size());
      return sum / static_cast<double>(result.set.bodies.size());
    };
    for (const bool explicit_margin : {false, true}) {
      SweepOptions options;
      options.epsilon = 0.01;
      options.explicit_margin = explicit_margin;
      const SweepResult plain = swept_volume(r.robot, r.bodies, path, options);
      EXPECT_EQ(plain.left_out, 0);
      options.simplify = 0.4;
      const SweepResult result = swept_volume(r.robot, r.bodies, path, options);
      EXPECT_LT(vertices(result), 0.8 * vertices(plain)) << r.name;
      EXPECT_LE(margin_of(result.set).value(), options.epsilon);
      EXPECT_GT(result.left_out, 0.1 * options.epsilon);
      EXPECT_LE(result.left_out, 0.4 * options.epsilon);
      EXPECT_EQ(geom::find_not_convex(result.set), std::nullopt);
      EXPECT_EQ(sample_points(r, path, result, random, 1000, true).missed, 0U) << r.name;
    }
  }
}

TEST(Sweep, WhatSimplifyingLeavesOutIsAsFarAwayAsTheMarginSays) {
  TestRobot r = six_axis_arm();
  Geometry ball;
  ball.shape = Geometry::Shape::Sphere;
  ball.size.x() = 0.06;
  r.bodies = {{"ball", 3, bounding_points(ball), 0}};
  SweepOptions options;
  options.epsilon = 0.01;
  options.simplify = 0.4;
  const std::vector<double> rest{0.1, 0.2, -0.3, 0.4, 0.5, 0.6};
  const SweepResult result = swept_volume(r.robot, r.bodies, {rest}, options);
  double farthest = 0;
  for (const Vec3& p : r.bodies[0].points)
    farthest = std::max(
        farthest, distance_to(result.set.bodies[0].core, reference_pose(r.robot, 3, rest) * p));
  EXPECT_NEAR(farthest, result.left_out, 1e-6);
  EXPECT_GT(result.left_out, 0.002);
  EXPECT_GE(margin_of(result.set).value(), farthest);
}

TEST(Sweep, ReachHoldsForPointsOfTheSet) {
  // Points of the hulls are near some configuration of the body, as `reach` promises.
  std::mt19937_64 random(35);
  const TestRobot r = six_axis_arm();
  const Path path = random_path(r.robot, random, 2, 1, false);
  const SweepResult result = make(r, path, 0.005);
  std::vector<geom::Mesh> hulls;
  for (const LinkBody& body : r.bodies) hulls.push_back(*geom::convex_hull(body.points));
  double most = 0;
  for (int k = 0; k < 300; ++k) {
    const std::size_t i = random() % result.pieces.size();
    const LinkBody& body = r.bodies[result.sources[i]];
    const auto& v = result.set.bodies[i].core.vertices;
    const Vec3 p = 0.5 * (v[random() % v.size()] + v[random() % v.size()]);
    double nearest = 1e9;
    for (int s = 0; s <= 400; ++s) {
      const Transform pose =
          reference_pose(r.robot, body.link, between(path[0], path[1], s / 400.0));
      nearest = std::min(nearest, distance_to(hulls[result.sources[i]],
                                              pose.linear.transpose() * (p - pose.translation)));
    }
    most = std::max(most, nearest);
  }
  EXPECT_LE(most, result.excess);
  EXPECT_GT(result.excess, margin_of(result.set).value());
}

TEST(Sweep, SameOnAnyNumberOfThreads) {
  std::mt19937_64 random(36);
  const TestRobot r = six_axis_arm();
  const Path path = random_path(r.robot, random, 4, 1.5, false);
  const auto with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return make(r, path, 0.002);
  };
  const SweepResult a = with(1), b = with(4);
  EXPECT_EQ(margin_of(a.set).value(), margin_of(b.set).value());
  EXPECT_EQ(a.excess, b.excess);
  ASSERT_EQ(a.set.bodies.size(), b.set.bodies.size());
  for (std::size_t i = 0; i < a.set.bodies.size(); ++i) {
    EXPECT_EQ(a.set.bodies[i].core.vertices, b.set.bodies[i].core.vertices);
    EXPECT_EQ(a.set.bodies[i].core.triangles, b.set.bodies[i].core.triangles);
  }
}

TEST(Sweep, FlatBodiesAndMargins) {
  TestRobot r = six_axis_arm();
  // A body without volume that turns in its own plane, and one with a margin of its own.
  r.bodies = {{"flat", 1, {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, 0},
              {"padded", 2, r.bodies[1].points, 0.001}};
  const Path path{std::vector<double>(6, 0), {0.5, 0, 0, 0, 0, 0}};
  const SweepResult result = make(r, path, 0.005);
  EXPECT_EQ(geom::find_not_convex(result.set), std::nullopt);
  EXPECT_GE(margin_of(result.set).value(), 0.001);
  EXPECT_LE(margin_of(result.set).value(), 0.005);
  r.bodies[1].margin = 0.004;
  EXPECT_THROW(make(r, path, 0.005), Error);
}

TEST(Sweep, RefusesWhatItCannotDo) {
  TestRobot r = six_axis_arm();
  const Path path{std::vector<double>(6, 0), std::vector<double>(6, 1)};
  EXPECT_THROW(make(r, path, 0), Error);
  EXPECT_THROW(make(r, path, -1), Error);
  EXPECT_THROW(make(r, {}, 0.01), Error);
  EXPECT_THROW(make(r, {{1, 2}}, 0.01), Error);
  for (const double share : {-0.1, 0.95}) {
    SweepOptions options;
    options.epsilon = 0.005;
    options.simplify = share;
    EXPECT_THROW(swept_volume(r.robot, r.bodies, path, options), Error);
  }
  EXPECT_EQ(make(r, path, 1e-6).stop, Stop::TooCoarse);
  r.robot.joints[0].origin.translation.x() = 1e6;
  const SweepResult far = make(r, path, 0.005);
  EXPECT_EQ(far.stop, Stop::TooCoarse);
  EXPECT_TRUE(far.set.bodies.empty());
  r.bodies[0].points.clear();
  EXPECT_THROW(make(r, path, 0.005), Error);
}

}  // namespace
}  // namespace kaboum::test
