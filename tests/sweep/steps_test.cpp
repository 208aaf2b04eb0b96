#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/sweep/steps.h>

#include <algorithm>
#include <cmath>

#include "sampling.h"

namespace kaboum::test {
namespace {

constexpr std::array kProved{StepRule::Uniform, StepRule::Subset, StepRule::SecondOrder,
                             StepRule::Adaptive, StepRule::Balanced};

std::size_t count(const TestRobot& r, const Path& path, StepRule rule, double epsilon,
                  bool merge = true) {
  SweepOptions options;
  options.epsilon = epsilon;
  options.rule = rule;
  options.merge = merge;
  return swept_volume(r.robot, r.bodies, path, options).pieces.size();
}

TEST(Steps, PiecesCoverThePathInOrder) {
  std::mt19937_64 random(21);
  for (const TestRobot& r : {six_axis_arm(), prismatic_chain()}) {
    const Path path = random_path(r.robot, random, 5, 1, false);
    for (const LinkBody& body : r.bodies) {
      for (const StepRule rule : {StepRule::SecondOrder, StepRule::Adaptive, StepRule::Balanced}) {
        StepOptions options;
        options.rule = rule;
        options.deviation = 0.01;
        const auto pieces = choose_steps(r.robot, body.link, body.points, path, options);
        std::size_t segment = 0;
        double at = 0;
        for (const PathInterval& p : pieces) {
          EXPECT_EQ(p.first_segment, segment);
          EXPECT_EQ(p.begin, at);
          EXPECT_LE(p.deviation, 0.01);
          segment = p.last_segment + (p.end == 1 ? 1 : 0);
          at = p.end == 1 ? 0 : p.end;
        }
        EXPECT_EQ(segment, 4U);
        EXPECT_EQ(at, 0);
      }
    }
  }
}

TEST(Steps, PointsStayWithinTheDeviationOfTheirSegment) {
  // The claim of every proved rule, sampled with poses that are computed by other means.
  std::mt19937_64 random(22);
  double nearest_to_bound = 0;
  for (const TestRobot& r : test_robots()) {
    for (const StepRule rule : kProved) {
      const Path path = random_path(r.robot, random, 3, 2, rule == StepRule::Uniform);
      SweepOptions options;
      options.epsilon = 0.01;
      options.rule = rule;
      const SweepResult result = swept_volume(r.robot, r.bodies, path, options);
      for (int k = 0; k < 600; ++k) {
        const std::size_t i = random() % result.pieces.size();
        const PathInterval& piece = result.pieces[i];
        if (piece.first_segment != piece.last_segment) continue;
        const double u = static_cast<double>(k % 21) / 20;
        const double s = piece.begin + u * (piece.end - piece.begin);
        const LinkBody& body = r.bodies[result.sources[i]];
        const Transform pose =
            reference_pose(r.robot, body.link,
                           between(path[piece.first_segment], path[piece.first_segment + 1], s));
        for (const Vec3& p : body.points) {
          const Vec3 chord = (1 - u) * (piece.start * p) + u * (piece.finish * p);
          const double away = (pose * p - chord).norm();
          EXPECT_LE(away, piece.deviation) << r.name;
          nearest_to_bound = std::max(nearest_to_bound, away / piece.deviation);
        }
      }
    }
  }
  EXPECT_GT(nearest_to_bound, 0.95);  // the bounds are no luxury
}

TEST(Steps, EachRuleNeedsFewerThanTheOneBefore) {
  // Sixty motions of a six-axis arm, half of them of some joints only; one body per link.
  const TestRobot r = six_axis_arm();
  std::mt19937_64 random(23);
  std::array<double, 5> sum{};
  for (int motion = 0; motion < 60; ++motion) {
    const Path path = random_path(r.robot, random, 2, 1.2, motion % 2 == 0);
    for (std::size_t k = 0; k < kProved.size(); ++k)
      sum[k] += static_cast<double>(count(r, path, kProved[k], 0.005)) / 60;
  }
  for (std::size_t k = 0; k < kProved.size(); ++k) {
    RecordProperty("bodies_" + std::to_string(k), std::to_string(sum[k]));
    std::printf("[ measured ] rule %zu: %.1f bodies per motion, %.2f times fewer than uniform\n", k,
                sum[k], sum[0] / sum[k]);
  }
  for (std::size_t k = 1; k < sum.size(); ++k) EXPECT_LT(sum[k], sum[k - 1]);
  EXPECT_GE(sum[0] / sum[2], 2);
  EXPECT_GE(sum[0] / sum[3], 3.5);
  EXPECT_GE(sum[0] / sum[4], 5);
}

TEST(Steps, ConvergeQuadratically) {
  // Joints within ±2π, as a UR5's: short motions reach the floor of one body per link.
  const TestRobot r = six_axis_arm();
  std::mt19937_64 random(24);
  std::vector<Path> paths;
  for (int i = 0; i < 8; ++i) paths.push_back(random_path(r.robot, random, 2, 6.28, false));
  for (const StepRule rule : {StepRule::Uniform, StepRule::Adaptive, StepRule::Balanced}) {
    std::vector<double> x, y;
    for (double epsilon = 0.05; epsilon > 0.00004; epsilon /= std::pow(10, 0.5)) {
      double total = 0;
      for (const Path& path : paths)
        for (const LinkBody& body : r.bodies) {
          StepOptions options;
          options.rule = rule;
          options.deviation = epsilon;
          options.shared.assign(1, {1.18, 0, 0});
          for (std::size_t j = 0; j < 6; ++j)
            options.shared[0].turn += std::abs(path[1][j] - path[0][j]);
          total += static_cast<double>(
              choose_steps(r.robot, body.link, body.points, path, options).size());
        }
      x.push_back(std::log(epsilon));
      y.push_back(std::log(total));
    }
    const auto n = static_cast<double>(x.size());
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sx += x[i];
      sy += y[i];
      sxx += x[i] * x[i];
      sxy += x[i] * y[i];
    }
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    std::printf("[ measured ] rule %d: slope %.4f\n", static_cast<int>(rule), slope);
    EXPECT_NEAR(slope, -0.5, 0.03);
  }
}

TEST(Steps, ManyWaypointsOnAStraightLineCostNothing) {
  const TestRobot r = six_axis_arm();
  std::mt19937_64 random(25);
  const Path two = random_path(r.robot, random, 2, 1, false);
  Path many;
  for (int i = 0; i <= 300; ++i) many.push_back(between(two[0], two[1], i / 300.0));
  const std::size_t direct = count(r, two, StepRule::Adaptive, 0.01);
  const std::size_t merged = count(r, many, StepRule::Adaptive, 0.01);
  EXPECT_LE(static_cast<double>(merged), 1.35 * static_cast<double>(direct));
  EXPECT_EQ(count(r, many, StepRule::Adaptive, 0.01, false), 300 * r.bodies.size());
  // Merged pieces hold what they promise.
  SweepOptions options;
  options.epsilon = 0.01;
  const SweepResult result = swept_volume(r.robot, r.bodies, many, options);
  const Missed missed = sample_points(r, many, result, random, 5000);
  EXPECT_EQ(missed.missed, 0U);
  EXPECT_GT(missed.largest, 0.5 * margin_of(result.set).value());
}

TEST(Steps, RestingLinksNeedOneBody) {
  const TestRobot r = six_axis_arm();
  Path path(4, std::vector<double>(6, 0.2));
  for (std::size_t i = 0; i < 4; ++i) path[i][4] = static_cast<double>(i % 2);
  StepOptions options;
  options.deviation = 0.001;
  EXPECT_EQ(choose_steps(r.robot, 3, r.bodies[2].points, path, options).size(), 1U);
  EXPECT_GT(choose_steps(r.robot, 5, r.bodies[4].points, path, options).size(), 3U);
  path.resize(1);
  EXPECT_EQ(choose_steps(r.robot, 6, r.bodies[5].points, path, options).size(), 1U);
}

TEST(Steps, LargestReachIsKept) {
  const TestRobot r = six_axis_arm();
  std::mt19937_64 random(26);
  const Path path = random_path(r.robot, random, 2, 1, false);
  StepOptions options;
  options.deviation = 0.005;
  const auto& body = r.bodies[1];
  const auto far = choose_steps(r.robot, body.link, body.points, path, options);
  options.max_excess = 0.008;
  const auto near = choose_steps(r.robot, body.link, body.points, path, options);
  EXPECT_GT(near.size(), far.size());
  for (const PathInterval& p : near) EXPECT_LE(excess(p, body.points), 0.008);
  options.max_excess = 1e-14;
  EXPECT_THROW(choose_steps(r.robot, body.link, body.points, path, options), Error);
}

TEST(Steps, BaginskiNeedsRevoluteJoints) {
  const TestRobot r = prismatic_chain();
  const Path path{{0, 0, 0, 0, 0}, {1, 0.1, 1, 1, 1}};
  EXPECT_THROW(count(r, path, StepRule::Baginski, 0.01), Error);
  const TestRobot six = six_axis_arm();
  const Path turn{std::vector<double>(6, 0), std::vector<double>(6, 1)};
  // Eq. 4.20 follows from Eq. 4.19 by a series, so the steps are nearly the same.
  const auto uniform = static_cast<double>(count(six, turn, StepRule::Uniform, 0.005));
  const auto baginski = static_cast<double>(count(six, turn, StepRule::Baginski, 0.005));
  EXPECT_LE(baginski, uniform);
  EXPECT_GT(baginski, 0.95 * uniform);
}

}  // namespace
}  // namespace kaboum::test
