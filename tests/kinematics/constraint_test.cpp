#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/kinematics/sample.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "arms.h"
#include "surfaces.h"

namespace kaboum::test {
namespace {

constexpr double kPi = std::numbers::pi;
const FrameId kWorld;
const FrameId kTool{FrameId::Kind::Tool, 0};
const FrameId kObject{FrameId::Kind::Object, 0};

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

Vec3 random_point(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  return {unit(random), unit(random), unit(random)};
}

/// 0: point, 1: line, 2: plane, 3: surface.
Feature random_feature(int kind, std::mt19937_64& random) {
  if (kind == 0) return Point{random_point(random)};
  if (kind == 1) return Line{random_point(random), random_direction(random)};
  if (kind == 3) return random_surface(random, 0.5);
  return Plane{random_point(random), random_direction(random)};
}

struct Case {
  Relation relation;
  int first, second;
  double value;
  int rows;
};

/// Every relation that there is, in one order.
const std::vector<Case> kCases = {
    {Relation::Coincident, 0, 0, 0, 3},    {Relation::Coincident, 0, 1, 0, 2},
    {Relation::Coincident, 0, 2, 0, 1},    {Relation::Coincident, 1, 1, 0, 4},
    {Relation::Coincident, 1, 2, 0, 2},    {Relation::Coincident, 2, 2, 0, 3},
    {Relation::Parallel, 1, 1, 0, 2},      {Relation::Parallel, 2, 2, 0, 2},
    {Relation::Parallel, 1, 2, 0, 1},      {Relation::Perpendicular, 1, 1, 0, 1},
    {Relation::Perpendicular, 2, 2, 0, 1}, {Relation::Perpendicular, 1, 2, 0, 2},
    {Relation::Distance, 0, 0, 0.7, 1},    {Relation::Distance, 0, 1, 0.4, 1},
    {Relation::Distance, 0, 2, 0.3, 1},    {Relation::Angle, 1, 1, 1.1, 1},
    {Relation::Angle, 2, 2, 2.5, 1},       {Relation::Angle, 1, 2, -0.6, 1},
    {Relation::Distance, 0, 0, 0, 1},      {Relation::Distance, 0, 1, 0, 1},
    {Relation::Distance, 0, 2, 0, 1},      {Relation::Coincident, 0, 3, 0, 2},
    {Relation::Distance, 0, 3, 0.3, 2},    {Relation::Parallel, 3, 3, 0, 2},
    {Relation::Parallel, 1, 3, 0, 1},      {Relation::Perpendicular, 2, 3, 0, 1},
    {Relation::Angle, 3, 3, 2.5, 1},       {Relation::Angle, 1, 3, -0.6, 1}};

Constraint random_constraint(const Case& c, bool swapped, std::mt19937_64& random) {
  Constraint out{c.relation,
                 {kObject, random_feature(c.first, random)},
                 {kWorld, random_feature(c.second, random)},
                 c.value};
  if (swapped) std::swap(out.first.feature, out.second.feature);
  return out;
}

/// A pose moved by a twist of size h along coordinate k.
Transform nudged(const Transform& pose, int k, double h) {
  if (k < 3) return {pose.linear, pose.translation + h * Vec3::Unit(k)};
  return {robot::rotation_about(Vec3::Unit(k - 3), h) * pose.linear, pose.translation};
}

TEST(Constraints, DerivativesAreThoseOfDifferences) {
  std::mt19937_64 random(1);
  for (const Case& c : kCases)
    for (int trial = 0; trial < 20; ++trial) {
      const Constraint constraint = random_constraint(c, trial % 2 == 1, random);
      const Transform a = random_pose(random, 1), b = random_pose(random, 1);
      const Cost exact = cost(constraint, a, b, 0.8);
      ASSERT_EQ(exact.value.size(), c.rows);
      constexpr double kStep = 1e-5;
      for (int k = 0; k < 6; ++k) {
        const auto slope = [&](const Transform& plus_a, const Transform& plus_b,
                               const Transform& minus_a, const Transform& minus_b) {
          return ((cost(constraint, plus_a, plus_b, 0.8).value -
                   cost(constraint, minus_a, minus_b, 0.8).value) /
                  (2 * kStep))
              .eval();
        };
        const auto first = slope(nudged(a, k, kStep), b, nudged(a, k, -kStep), b);
        const auto second = slope(a, nudged(b, k, kStep), a, nudged(b, k, -kStep));
        EXPECT_LT((first - exact.first.col(k)).cwiseAbs().maxCoeff(), 1e-7)
            << static_cast<int>(c.relation) << c.first << c.second << " by " << k;
        EXPECT_LT((second - exact.second.col(k)).cwiseAbs().maxCoeff(), 1e-7);
      }
    }
}

/// How far a relation is from holding, in words of geometry: distances and angles.
double violation(const Constraint& c, const Transform& frame) {
  const auto place = [&](const PlacedFeature& p, Vec3& point, Vec3& direction) {
    const Transform t = p.frame == kWorld ? Transform{} : frame;
    if (const auto* x = std::get_if<Point>(&p.feature)) point = t * x->position;
    if (const auto* x = std::get_if<Line>(&p.feature)) {
      point = t * x->position;
      direction = t.linear * x->direction;
    }
    if (const auto* x = std::get_if<Plane>(&p.feature)) {
      point = t * x->position;
      direction = t.linear * x->normal;
    }
    if (const auto* x = std::get_if<Surface>(&p.feature)) {
      point = t * x->position;
      direction = t.linear * x->normal;
    }
  };
  const bool swap = c.first.feature.index() > c.second.feature.index();
  Vec3 p, q, d, e;
  place(swap ? c.second : c.first, p, d);
  place(swap ? c.first : c.second, q, e);
  const std::size_t first = std::min(c.first.feature.index(), c.second.feature.index()),
                    second = std::max(c.first.feature.index(), c.second.feature.index());
  // Distance of p from the second feature.
  const double away = second == 0   ? (p - q).norm()
                      : second == 1 ? (p - q).cross(e).norm()
                                    : std::abs((p - q).dot(e));
  const double angle = std::atan2(d.cross(e).norm(), d.dot(e));
  const double skew = std::min(angle, kPi - angle), square = std::abs(angle - kPi / 2);
  const bool line_plane = first == 1 && second >= 2;
  if (first == 0 && second == 3) {
    const PlacedFeature& surface = swap ? c.first : c.second;
    const Transform back = surface.frame == kWorld ? Transform{} : inverse(frame);
    return distance_from_surface<double>(std::get<Surface>(surface.feature), back * p, c.value);
  }
  switch (c.relation) {
    case Relation::Coincident:
      return away + (first == 0 ? 0 : line_plane ? square : skew);
    case Relation::Parallel:
      return line_plane ? square : skew;
    case Relation::Perpendicular:
      return line_plane ? skew : square;
    case Relation::Distance:
      return std::abs(away - c.value);
    default:
      return std::abs((line_plane ? kPi / 2 - angle : angle) - c.value);
  }
}

TEST(Constraints, SamplesOfEveryRelationMeetIt) {
  std::mt19937_64 random(2);
  for (const Case& c : kCases)
    for (int trial = 0; trial < 10; ++trial) {
      // The distance 0 of a point is reached with half the digits: its cost has a kink there.
      const bool kink = c.relation == Relation::Distance && c.value == 0;
      ConstraintProblem problem{{}, {{}}, {random_constraint(c, trial % 2 == 1, random)}};
      SampleOptions options;
      options.seed = static_cast<std::uint64_t>(trial);
      ConstraintSampler sampler(problem, options);
      for (int i = 0; i < 5; ++i) {
        const auto sample = sampler.next();
        ASSERT_TRUE(sample) << static_cast<int>(c.relation) << c.first << c.second;
        EXPECT_LT(violation(problem.constraints[0], sample->at.objects[0]), kink ? 1e-8 : 4e-9)
            << static_cast<int>(c.relation) << c.first << c.second;
        EXPECT_LE(sample->error, 1e-9);
      }
      EXPECT_GE(sampler.tally().projected * 10, sampler.tally().draws * 9);
    }
}

TEST(Constraints, TheCostVanishesOnlyWhereTheRelationHolds) {
  // By the same words of geometry: no cost is small where the violation is not.
  std::mt19937_64 random(3);
  for (const Case& c : kCases) {
    ConstraintProblem problem{{}, {{}}, {random_constraint(c, false, random)}};
    ConstraintSampler sampler(problem);
    for (int i = 0; i < 30; ++i) {
      const auto sample = sampler.next();
      ASSERT_TRUE(sample);
      std::normal_distribution<double> normal(0, 1e-3);
      Transform pose = sample->at.objects[0];
      pose.translation += Vec3(normal(random), normal(random), normal(random));
      pose.linear = robot::rotation_about(random_direction(random), normal(random)) * pose.linear;
      const double off = violation(problem.constraints[0], pose);
      const double value = cost(problem.constraints[0], pose, {}, 1).value.norm();
      EXPECT_GT(value, 0.3 * off);
      EXPECT_LT(value, 3 * off + 1e-12);
    }
  }
}

/// An arm with a spherical wrist and one with seven axes, both placed; two objects.
ConstraintProblem two_robots() {
  const double quarter = kPi / 2;
  DhArm seven;
  seven.rows = {{0, .34, 0, -quarter}, {0, 0, 0, quarter}, {0, .4, 0, quarter}, {0, 0, 0, -quarter},
                {0, .4, 0, -quarter},  {0, 0, 0, quarter}, {0, .126, 0, 0}};
  ConstraintProblem problem;
  problem.robots = {
      {arm_of(rv_6sl(true)), {robot::rotation_from_rpy(0, 0, 0.3), {0.05, -0.1, 0.02}}},
      {arm_of(seven), {robot::rotation_from_rpy(0, 0, kPi), {0.9, 0.1, 0}}}};
  for (PlacedArm& r : problem.robots)
    for (Axis& axis : r.arm.axes) {
      axis.lower = -2.8;
      axis.upper = 2.9;
    }
  problem.objects = {{{0.2, -0.3, 0.2}, {0.7, 0.3, 0.6}}, {{-1, -1, 0}, {1, 1, 1}}};
  const FrameId other{FrameId::Kind::Tool, 1}, cup{FrameId::Kind::Object, 1};
  // Both hold a rod by its axis, a hand apart; the cup stands on the table below the rod's middle.
  problem.constraints = {{Relation::Coincident, {kTool, Point{}}, {kObject, Line{}}},
                         {Relation::Perpendicular, {kTool, Line{}}, {kObject, Line{}}},
                         {Relation::Distance, {kTool, Point{}}, {kObject, Point{}}, 0.1},
                         {Relation::Coincident, {other, Point{}}, {kObject, Line{}}},
                         {Relation::Distance, {other, Point{}}, {kObject, Point{}}, 0.1},
                         {Relation::Distance, {kTool, Point{}}, {other, Point{}}, 0.2},
                         {Relation::Coincident, {cup, Plane{}}, {kWorld, Plane{}}},
                         {Relation::Coincident, {cup, Line{}}, {kObject, Point{}}}};
  return problem;
}

TEST(Sampling, DerivativesByJointsAndObjectsAreThoseOfDifferences) {
  const ConstraintProblem problem = two_robots();
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 10; ++trial) {
    Placement at{{random_joints(random, 6, 2), random_joints(random, 7, 2)},
                 {random_pose(random, 1), random_pose(random, 1)}};
    const Costs exact = evaluate(problem, at, 1);
    ASSERT_EQ(exact.derivative.cols(), 6 + 7 + 12);
    for (Eigen::Index column = 0; column < exact.derivative.cols(); ++column) {
      const auto k = static_cast<std::size_t>(column);
      const auto value = [&](double h) {
        Placement x = at;
        if (k < 6) x.joints[0][k] += h;
        if (k >= 6 && k < 13) x.joints[1][k - 6] += h;
        if (k >= 13) {
          const std::size_t object = (k - 13) / 6;
          x.objects[object] = nudged(x.objects[object], static_cast<int>((k - 13) % 6), h);
        }
        return evaluate(problem, x, 1).value;
      };
      const Eigen::VectorXd slope = (value(1e-5) - value(-1e-5)) / 2e-5;
      EXPECT_LT((slope - exact.derivative.col(column)).cwiseAbs().maxCoeff(), 1e-7) << column;
    }
  }
}

TEST(Sampling, SeveralRobotsAndObjectsAtOnce) {
  const ConstraintProblem problem = two_robots();
  SampleOptions options;
  options.draws = 300;
  ConstraintSampler sampler(problem, options);
  for (int i = 0; i < 20; ++i) {
    const auto s = sampler.next();
    ASSERT_TRUE(s) << i;
    for (std::size_t r = 0; r < 2; ++r)
      EXPECT_TRUE(within_limits(problem.robots[r].arm, s->at.joints[r]));
    // In other words: where are the two hands on the rod, and where is the cup?
    const Vec3 a =
        problem.robots[0].base * reference_pose(rv_6sl(true), s->at.joints[0]).translation;
    const Vec3 b =
        (problem.robots[1].base * kinematics::forward(problem.robots[1].arm, s->at.joints[1]))
            .translation;
    const Transform& rod = s->at.objects[0];
    EXPECT_LT(((a + b) / 2 - rod.translation).norm(), 1e-6);
    EXPECT_NEAR((a - b).norm(), 0.2, 1e-8);
    EXPECT_NEAR(s->at.objects[1].translation.z(), 0, 1e-8);
    EXPECT_LT((s->at.objects[1].translation - rod.translation).head<2>().norm(), 1e-7);
  }
}

/// The tool's plane on a table, its centre 0.1 above it or below.
ConstraintProblem place_on_table(const DhArm& dh) {
  ConstraintProblem problem;
  problem.robots = {{arm_of(dh), {}}};
  for (Axis& axis : problem.robots[0].arm.axes) {
    axis.lower = -2.4;
    axis.upper = 2.6;
  }
  problem.constraints = {{Relation::Parallel, {kTool, Plane{}}, {kWorld, Plane{}}},
                         {Relation::Distance, {kTool, Point{}}, {kWorld, Plane{}}, 0.1}};
  return problem;
}

/// Which sides of its branches a configuration is on: signs that inverse kinematics may choose.
int branch(const std::vector<double>& q) {
  return (std::cos(q[4] + kPi) > 0 ? 1 : 0) + (std::sin(q[4] + kPi) > 0 ? 2 : 0) +
         (std::sin(q[2]) > 0 ? 4 : 0);
}

TEST(Sampling, AllOfTheConstraintIsCovered) {
  const ConstraintProblem problem = place_on_table(rv_6sl(true));
  for (const bool closed_form : {true, false}) {
    SampleOptions options;
    options.closed_form = closed_form;
    ConstraintSampler sampler(problem, options);
    std::set<int> bins, turns, branches;
    for (int i = 0; i < 1500; ++i) {
      const auto s = sampler.next();
      ASSERT_TRUE(s);
      const Transform tool = reference_pose(rv_6sl(true), s->at.joints[0]);
      EXPECT_TRUE(within_limits(problem.robots[0].arm, s->at.joints[0]));
      EXPECT_NEAR(std::abs(tool.translation.z()), 0.1, 1e-8);
      EXPECT_NEAR(std::abs(tool.linear(2, 2)), 1, 1e-8);
      bins.insert(static_cast<int>(std::floor(tool.translation.y() / 0.1)));
      turns.insert(static_cast<int>(
          std::floor(std::atan2(tool.linear(1, 0), tool.linear(0, 0)) / (kPi / 9))));
      branches.insert(branch(s->at.joints[0]));
    }
    EXPECT_GE(bins.size(), 14U);
    EXPECT_EQ(turns.size(), 18U);
    EXPECT_GE(branches.size(), 5U);
  }
}

TEST(Sampling, ManyDrawsEndWithinTheLimits) {
  for (const bool closed_form : {true, false}) {
    SampleOptions options;
    options.closed_form = closed_form;
    ConstraintSampler sampler(place_on_table(rv_6sl(true)), options);
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(sampler.next());
    // Algorithm 3 without limits: a quarter.
    EXPECT_GT(sampler.tally().samples * 100, sampler.tally().draws * 35);
  }
}

/// The tool's z along a cylinder's axis, its centre on the rim, its x in the plane of the top.
ConstraintProblem rim_of_cylinder(const DhArm& dh) {
  ConstraintProblem problem = place_on_table(dh);
  const Vec3 centre(0.5, 0, 0.2);
  problem.constraints = {
      {Relation::Parallel, {kTool, Line{}}, {kWorld, Line{centre, {0, 0, 1}}}},
      {Relation::Distance, {kTool, Point{}}, {kWorld, Line{centre, {0, 0, 1}}}, 0.05},
      {Relation::Coincident,
       {kTool, Line{{0, 0, 0}, {1, 0, 0}}},
       {kWorld, Plane{centre, {0, 0, 1}}}}};
  return problem;
}

TEST(Sampling, OneDrawIsEnoughWhereTheConstraintsLeaveMotionsFree) {
  for (const ConstraintProblem& problem :
       {place_on_table(rv_6sl(true)), rim_of_cylinder(rv_6sl(true))}) {
    SampleOptions options;
    options.draws = 1;
    const auto share = [&] {
      ConstraintSampler sampler(problem, options);
      int samples = 0;
      for (int i = 0; i < 1000; ++i) {
        const auto s = sampler.next();
        if (!s) continue;
        ++samples;
        EXPECT_TRUE(within_limits(problem.robots[0].arm, s->at.joints[0]));
        EXPECT_LE(evaluate(problem, s->at, 1).largest(), 1e-8);
      }
      return samples;
    };
    EXPECT_EQ(share(), 1000);
    options.motions = 0;
    EXPECT_LT(share(), 800);
  }
}

TEST(Sampling, MotionsAreFreeOnlyWhereAllConstraintsLeaveThem) {
  // A given direction of the tool's x leaves no turn about its z, a given height no slide upwards.
  ConstraintProblem problem = place_on_table(rv_6sl(true));
  problem.constraints.push_back({Relation::Parallel,
                                 {kTool, Line{{0, 0, 0}, {1, 0, 0}}},
                                 {kWorld, Line{{0, 0, 0}, {0, 1, 0}}}});
  ConstraintSampler sampler(problem);
  for (int i = 0; i < 300; ++i) {
    const auto s = sampler.next();
    ASSERT_TRUE(s);
    const Transform tool = reference_pose(rv_6sl(true), s->at.joints[0]);
    EXPECT_NEAR(std::abs(tool.translation.z()), 0.1, 1e-8);
    EXPECT_NEAR(std::abs(tool.linear(1, 0)), 1, 1e-8);
    EXPECT_NEAR(std::abs(tool.linear(2, 2)), 1, 1e-8);
  }
  EXPECT_GE(sampler.tally().samples * 100, sampler.tally().draws * 90);
}

TEST(Sampling, AllConfigurationsOfAPoseAreDrawn) {
  // The tool's point and axes are given, but for their directions: four poses.
  const Transform pose = reference_pose(rv_6sl(true), {0.2, 0.3, 0.9, 0.4, 0.8, 0.1});
  ConstraintProblem problem = place_on_table(rv_6sl(true));
  const Vec3 p = pose.translation, x = pose.linear.col(0), z = pose.linear.col(2);
  problem.constraints = {
      {Relation::Coincident, {kTool, Point{}}, {kWorld, Point{p}}},
      {Relation::Parallel, {kTool, Line{}}, {kWorld, Line{p, z}}},
      {Relation::Parallel, {kTool, Line{{0, 0, 0}, {1, 0, 0}}}, {kWorld, Line{p, x}}}};
  for (Axis& axis : problem.robots[0].arm.axes) {
    axis.lower = -kPi;
    axis.upper = kPi;
  }
  const auto form = recognise(problem.robots[0].arm);
  ASSERT_TRUE(form);
  std::size_t all = 0;
  for (const double turn : {0.0, kPi})
    for (const double flip : {0.0, kPi})
      all += solve(*form, {pose.linear * robot::rotation_from_rpy(flip, 0, turn), p}).size();
  ConstraintSampler sampler(problem);
  std::vector<std::vector<double>> seen;
  for (int i = 0; i < 600; ++i) {
    const auto s = sampler.next();
    ASSERT_TRUE(s);
    bool known = false;
    for (const auto& q : seen) known = known || turn_distance(q.data(), s->at.joints[0]) < 1e-6;
    if (!known) seen.push_back(s->at.joints[0]);
  }
  EXPECT_EQ(seen.size(), all);
  EXPECT_GE(all, 8U);
}

TEST(Sampling, CostsThatAreNoNumbersAreNotDropped) {
  ConstraintProblem problem;
  problem.objects.resize(2);
  const auto coincide = [](std::size_t object) {
    return Constraint{Relation::Coincident,
                      {{FrameId::Kind::Object, object}, Point{}},
                      {{FrameId::Kind::World, 0}, Point{}}};
  };
  problem.constraints = {coincide(0), coincide(1)};
  Placement at;
  at.objects.resize(2);
  EXPECT_EQ(evaluate(problem, at, 1).largest(), 0);
  at.objects[0].translation.y() = -2;
  EXPECT_EQ(evaluate(problem, at, 1).largest(), 2);
  for (const std::size_t i : {0U, 1U}) {  // before a larger cost and after it
    Placement bad = at;
    bad.objects[i].translation.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(evaluate(problem, bad, 1).largest())) << i;
  }
  EXPECT_EQ(Costs().largest(), 0);
}

TEST(Sampling, TheSameSeedGivesTheSameBits) {
  SampleOptions options;
  options.seed = 5;
  ConstraintSampler a(two_robots(), options), b(two_robots(), options);
  for (int i = 0; i < 5; ++i) {
    const auto x = a.next(), y = b.next();
    ASSERT_EQ(x.has_value(), y.has_value());
    if (!x) continue;
    EXPECT_EQ(x->at.joints, y->at.joints);
    EXPECT_EQ(x->draws, y->draws);
    EXPECT_EQ(x->at.objects[0].linear, y->at.objects[0].linear);
  }
  options.seed = 6;
  ConstraintSampler c(place_on_table(rv_6sl(true)), options);
  options.seed = 7;
  ConstraintSampler d(place_on_table(rv_6sl(true)), options);
  EXPECT_NE(c.next()->at.joints, d.next()->at.joints);
}

TEST(Sampling, WhatCannotBeMetHasNoSamples) {
  ConstraintProblem problem = place_on_table(rv_6sl(true));
  problem.constraints[1].value = 3;  // above all that the arm reaches
  for (const bool closed_form : {true, false}) {
    SampleOptions options;
    options.closed_form = closed_form;
    options.draws = 20;
    EXPECT_FALSE(ConstraintSampler(problem, options).next());
  }
  problem = place_on_table(rv_6sl(true));  // they contradict each other
  problem.constraints.push_back({Relation::Perpendicular, {kTool, Plane{}}, {kWorld, Plane{}}});
  EXPECT_FALSE(ConstraintSampler(problem).next());
}

TEST(Surfaces, NearestPointsAreNearestAndPointsAreEvenlySpread) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 200; ++round) {
    const Surface s = random_surface(random, 1);
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = s.position + 2 * random_point(random);
      EXPECT_NEAR((nearest_point(s, p) - p).norm(), distance_from_surface<double>(s, p, 0), 1e-12);
      EXPECT_LT(distance_from_surface<double>(s, nearest_point(s, p), 0), 1e-12);
      EXPECT_LT(distance_from_surface<double>(shifted(s, 0.5), nearest_point(s, p), -0.5), 1e-12);
    }
  }
  // Of a square and of a disc, as many points on each side of a line through the middle, and as
  // many as there is area within half of the size.
  const Surface square{{0, 0, 0}, {0, 0, 1}, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, 0};
  const Surface disc{{0, 0, 0}, {0, 0, 1}, {}, 1};
  constexpr int kPoints = 100;
  int left = 0, inner = 0, round_inner = 0;
  for (int i = 0; i < kPoints; ++i)
    for (int k = 0; k < kPoints; ++k) {
      const double u = (i + 0.5) / kPoints, v = (k + 0.5) / kPoints;
      const Vec3 p = point_at(square, u, v);
      EXPECT_LT(distance_from_surface<double>(square, p, 0), 1e-12);
      left += p.x() < 0 ? 1 : 0;
      inner += p.cwiseAbs().maxCoeff() < 0.5 ? 1 : 0;
      round_inner += point_at(disc, u, v).norm() < 0.5 ? 1 : 0;
    }
  EXPECT_NEAR(left, kPoints * kPoints / 2, kPoints);
  EXPECT_NEAR(inner, kPoints * kPoints / 4, kPoints);
  EXPECT_NEAR(round_inner, kPoints * kPoints / 4, kPoints);
}

TEST(Sampling, APointOnASurfaceIsAnywhereOnIt) {
  // A cup stands upright on a square table, its rim's point over a smaller one.
  const Surface table{{0, 0, 0}, {0, 0, 1}, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 0};
  const Surface shelf{{0.5, 0.5, 0.2}, {0, 0, 1}, {}, 0.3};
  ConstraintProblem problem{
      {},
      {{}},
      {{Relation::Distance, {kWorld, table}, {kObject, Point{}}, 0.1},
       {Relation::Angle, {kObject, Line{}}, {kWorld, Line{}}, 0},
       {Relation::Coincident, {kObject, Point{{0, 0, 0.1}}}, {kWorld, shelf}}}};
  ConstraintSampler both(problem);
  problem.constraints.pop_back();
  ConstraintSampler one(problem);
  std::set<std::pair<int, int>> cells;
  for (int i = 0; i < 400; ++i) {
    const auto anywhere = one.next();
    ASSERT_TRUE(anywhere);
    const Vec3 at = anywhere->at.objects[0].translation;
    EXPECT_NEAR(at.z(), 0.1, 1e-8);
    cells.emplace(static_cast<int>(4 * at.x()), static_cast<int>(4 * at.y()));
    const auto sample = both.next();
    if (!sample) continue;
    EXPECT_LT((sample->at.objects[0].translation - Vec3(0.5, 0.5, 0.1)).norm(), 0.3 + 1e-8);
  }
  EXPECT_EQ(cells.size(), 16U);
  EXPECT_GT(both.tally().samples, 100U);
}

std::string message_of(const Constraint& c) {
  ConstraintProblem problem{{}, {{}}, {c}};
  try {
    ConstraintSampler sampler(problem);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Sampling, SaysWhatIsWrongWithConstraints) {
  const auto says = [](const Constraint& c, const char* words) {
    EXPECT_NE(message_of(c).find(words), std::string::npos) << message_of(c);
  };
  says({Relation::Parallel, {kObject, Point{}}, {kWorld, Line{}}},
       "parallel of a point and a line is not defined (constraint 0");
  says({Relation::Distance, {kObject, Line{}}, {kWorld, Line{}}, 1}, "not defined");
  const Surface disc{{0, 0, 0}, {0, 0, 1}, {}, 1};
  says({Relation::Coincident, {kObject, disc}, {kWorld, Line{}}},
       "coincident of a surface and a line is not defined");
  says({Relation::Coincident, {kObject, disc}, {kWorld, disc}}, "not defined");
  says({Relation::Parallel, {kObject, Point{}}, {kWorld, disc}}, "not defined");
  for (const Surface& none :
       {Surface{}, Surface{{0, 0, 0}, {0, 0, 1}, {{0, 0, 0}, {1, 0, 0}}, 0},
        Surface{{0, 0, 0}, {0, 0, 1}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0},
        Surface{{0, 0, 0}, {0, 0, 1}, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, 0},
        Surface{{0, 0, 0}, {0, 0, 1}, {{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0}}, 0},
        Surface{{0, 0, 0}, {0, 0, 1}, {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}, 0}})
    says({Relation::Coincident, {kObject, Point{}}, {kWorld, none}}, "convex outline");
  says({Relation::Distance, {kObject, Point{}}, {kWorld, Line{}}, -1}, "at least 0");
  says({Relation::Angle, {kObject, Line{}}, {kWorld, Line{}}, 4}, "within 0 and pi");
  says({Relation::Angle, {kObject, Line{}}, {kWorld, Plane{}}, 2}, "-pi/2 and pi/2");
  says({Relation::Coincident, {kObject, Point{}}, {kObject, Point{}}}, "same frame");
  says({Relation::Coincident, {kTool, Point{}}, {kObject, Point{}}}, "no robot number 0");
  says({Relation::Parallel, {kObject, Line{{0, 0, 0}, {0, 0, 2}}}, {kWorld, Line{}}},
       "unit length");
  EXPECT_EQ(message_of({Relation::Parallel, {kObject, Line{}}, {kWorld, Line{}}}), "");
}

}  // namespace
}  // namespace kaboum::test
