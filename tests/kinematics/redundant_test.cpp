// Arms with redundant joints before a closed form: on a rail, on a platform, on a torso. What is
// found is judged by products of long doubles, what is not by a numeric search from many starts.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/kinematics/inverse.h>
#include <kaboum/kinematics/redundant.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "arms.h"

namespace kaboum::test {
namespace {

constexpr double kHalfCircle = std::numbers::pi;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A joint of a carrier: a unit direction, a point, limits.
Axis joint(bool turns, const Vec3& direction, const Vec3& point, double lower, double upper,
           double rate = 1) {
  Axis axis;
  axis.turns = turns;
  axis.direction = direction;
  axis.point = point;
  axis.lower = lower;
  axis.upper = upper;
  axis.rate = rate;
  return axis;
}

DhArm ur5() {
  DhArm dh;
  dh.rows = {{0, .089159, 0, kHalfCircle / 2},
             {0, 0, -.425, 0},
             {0, 0, -.39225, 0},
             {0, .10915, 0, kHalfCircle / 2},
             {0, .09465, 0, -kHalfCircle / 2},
             {0, .0823, 0, 0}};
  return dh;
}

/// An arm that stands on a carrier.
struct Carried {
  const char* name;
  std::vector<Axis> carrier;
  DhArm dh;
  Arm arm;
};

Carried carried(const char* name, std::vector<Axis> carrier, const DhArm& dh) {
  Carried out{name, std::move(carrier), dh, {}};
  out.arm = arm_of(dh);
  for (Axis& axis : out.arm.axes) {
    axis.lower = -2.9;
    axis.upper = 2.8;
  }
  out.arm.axes.insert(out.arm.axes.begin(), out.carrier.begin(), out.carrier.end());
  out.arm.variables.clear();
  return out;
}

std::vector<Carried> carried_arms() {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), none = Vec3::Zero();
  std::vector<Carried> out;
  out.push_back(carried("rail", {joint(false, y, none, -1.5, 1.5)}, rv_6sl(true)));
  out.push_back(carried("slow rail", {joint(false, x, none, -3, 3, 0.5)}, ur5()));
  out.push_back(carried("slanted rail", {joint(false, Vec3(0.6, 0, 0.8), {0, 1, 0}, 0, 3)}, ur5()));
  out.push_back(carried("torso", {joint(true, z, {-0.4, 0.1, 0}, -2, 2.5)}, rv_6sl(true)));
  out.push_back(carried(
      "rail and torso",
      {joint(false, y, none, -1, 2), joint(true, z, {-0.3, 0, 0}, -kInfinite, kInfinite)}, ur5()));
  // A trolley on a turning beam, and a torso behind another one.
  out.push_back(carried(
      "crane", {joint(true, z, {-2, 0, 0}, -2, 2), joint(false, x, {0, 0, 0.1}, 0, 1.5)}, ur5()));
  out.push_back(carried("two torsos",
                        {joint(true, z, {-1, 0, 0}, -1, 2), joint(true, y, {0, 0.2, 0}, -0.5, 0.4)},
                        rv_6sl(true)));
  out.push_back(carried("platform",
                        {joint(false, x, none, -1, 1), joint(false, y, none, -1, 1),
                         joint(true, z, none, -kHalfCircle, kHalfCircle)},
                        rv_6sl(true)));
  return out;
}

/// Values of the joints at random, within limits; of those without, within a turn.
std::vector<double> random_configuration(const Arm& arm, std::mt19937_64& random) {
  std::vector<double> q;
  for (const Axis& axis : arm.axes) {
    const bool limited = std::isfinite(axis.lower) && std::isfinite(axis.upper);
    q.push_back(std::uniform_real_distribution<double>(limited ? axis.lower : -kHalfCircle,
                                                       limited ? axis.upper : kHalfCircle)(random));
  }
  return q;
}

/// The tool's pose by the carrier's motions, one by one, and products of long doubles.
Transform pose_of(const Carried& c, const std::vector<double>& q) {
  Transform base;
  for (std::size_t i = 0; i < c.carrier.size(); ++i) {
    const Axis& axis = c.carrier[i];
    const double by = axis.rate * q[i];
    if (axis.turns) {
      const Mat3 turn = Eigen::AngleAxisd(by, axis.direction).toRotationMatrix();
      base = base * Transform{turn, axis.point - turn * axis.point};
    } else {
      base = base * Transform{Mat3::Identity(), by * axis.direction};
    }
  }
  return base * reference_pose(c.dh, {q.begin() + static_cast<long>(c.carrier.size()), q.end()});
}

TEST(Redundant, PosesOfConfigurationsAreReachedWithinTheLimits) {
  std::mt19937_64 random(1);
  for (const Carried& c : carried_arms()) {
    const auto redundant = recognise_redundant(c.arm);
    ASSERT_TRUE(redundant) << c.name;
    EXPECT_EQ(redundant->count, c.carrier.size());
    std::size_t missed = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const Transform target = pose_of(c, random_configuration(c.arm, random));
      RedundantOptions options;
      options.reference = random_configuration(c.arm, random);
      const RedundantSolutions all = solve_redundant(*redundant, target, options);
      EXPECT_FALSE(all.out_of_reach) << c.name;
      if (all.found.empty()) ++missed;
      double before = 0;
      for (const RedundantSolution& s : all.found) {
        const PoseError error = difference(pose_of(c, s.q), target);
        EXPECT_LT(error.position + error.rotation, 1e-8) << c.name;
        std::vector<double> first(s.q.begin(), s.q.begin() + static_cast<long>(c.carrier.size()));
        EXPECT_TRUE(within_limits(redundant->carrier, first)) << c.name;
        if (c.carrier.size() > 1) continue;
        EXPECT_GE(std::abs(first[0] - options.reference[0]), before - 1e-12) << c.name;
        before = std::abs(first[0] - options.reference[0]);
      }
    }
    // Some poses are reached with a few values only of the redundant joints.
    EXPECT_LE(missed, 2U) << c.name;
  }
}

TEST(Redundant, WhatANumericSearchFindsIsNotOutOfReach) {
  std::mt19937_64 random(2);
  std::size_t found = 0, proved = 0, missed = 0;
  for (const Carried& c : carried_arms()) {
    const auto redundant = recognise_redundant(c.arm);
    ASSERT_TRUE(redundant);
    for (int trial = 0; trial < 60; ++trial) {
      // Many of these are near the border of reach.
      Transform target = random_pose(random, 1);
      target.translation *= 1.6;
      NumericOptions starts;
      starts.starts = 20;
      starts.seed = static_cast<std::uint64_t>(trial) + 1;
      const bool numeric = solve_numeric(c.arm, target, starts).has_value();
      const RedundantSolutions answer = solve_redundant(*redundant, target);
      EXPECT_FALSE(numeric && answer.out_of_reach) << c.name << ' ' << trial;
      EXPECT_FALSE(answer.out_of_reach && !answer.found.empty());
      if (numeric && answer.found.empty()) ++missed;
      found += numeric ? 1 : 0;
      proved += answer.out_of_reach ? 1 : 0;
    }
  }
  EXPECT_GT(found, 60U);
  EXPECT_GT(proved, 30U);
  EXPECT_LE(missed * 50, found);
}

TEST(Redundant, TheBorderOfReachIsWhereTheStretchedArmIs) {
  // The UR5 on a rail along y from −1 to 2 m, stretched beyond the rail's end: its tool by a
  // thousandth farther is out of reach for certain, by a thousandth nearer it is not.
  const Vec3 y = Vec3::UnitY();
  const Carried c = carried("rail", {joint(false, y, Vec3::Zero(), -1, 2)}, ur5());
  const auto redundant = recognise_redundant(c.arm);
  ASSERT_TRUE(redundant);
  const double links = .425 + .39225 + .09465, side = .10915;  // forearm and upper arm, wrist
  const double radius = std::hypot(links, side);
  for (const double more : {1.001, 0.999}) {
    // Where the last frame's origin is, seen from the shoulder's height on axis 1.
    Transform target;
    target.translation =
        Vec3(0, 2 + more * radius, .089159) - redundant->form.tool_inverse.translation;
    EXPECT_EQ(solve_redundant(*redundant, target).out_of_reach, more > 1) << more;
  }
}

TEST(Redundant, TheReferenceIsKeptWhereItReaches) {
  std::mt19937_64 random(3);
  for (const Carried& c : carried_arms()) {
    const auto redundant = recognise_redundant(c.arm);
    const std::vector<double> q = random_configuration(c.arm, random);
    RedundantOptions options;
    options.reference = q;
    const Transform target = pose_of(c, q);
    const RedundantSolutions all = solve_redundant(*redundant, target, options);
    ASSERT_FALSE(all.found.empty()) << c.name;
    for (std::size_t k = 0; k < redundant->count; ++k)
      EXPECT_EQ(all.found.front().q[k], q[k]) << c.name;
    double nearest = 100;
    for (const RedundantSolution& s : solve_with_redundant(*redundant, target, q)) {
      for (std::size_t k = 0; k < redundant->count; ++k) EXPECT_EQ(s.q[k], q[k]);
      nearest = std::min(nearest, turn_distance(s.q.data(), q));
    }
    EXPECT_LT(nearest, 1e-6) << c.name;
  }
}

TEST(Redundant, AllOfTheRailThatReachesIsTried) {
  // A slow rail along y: from both sides of the target, as far as the arm reaches.
  Carried c = carried("slow rail", {joint(false, Vec3::UnitY(), Vec3::Zero(), -6, 6, 0.5)}, ur5());
  for (std::size_t i = 1; i < c.arm.axes.size(); ++i) {
    c.arm.axes[i].lower = -kHalfCircle;
    c.arm.axes[i].upper = kHalfCircle;
  }
  const auto redundant = recognise_redundant(c.arm);
  RedundantOptions options;
  options.values = 500;
  const Transform target{robot::rotation_from_rpy(kHalfCircle, 0, 0), {0.3, 0.2, 0.2}};
  const RedundantSolutions all = solve_redundant(*redundant, target, options);
  double least = 100, most = -100;
  for (const RedundantSolution& s : all.found) {
    least = std::min(least, 0.5 * s.q[0] - 0.2);
    most = std::max(most, 0.5 * s.q[0] - 0.2);
  }
  EXPECT_GT(most, 0.6);
  EXPECT_NEAR(least, -most, 0.05);
}

TEST(Redundant, LimitsOfOneSideAndOfNone) {
  std::mt19937_64 random(4);
  Carried c = carried_arms().front();
  for (const auto& [lower, upper] : std::vector<std::pair<double, double>>{
           {-kInfinite, kInfinite}, {0.5, kInfinite}, {-kInfinite, -0.5}, {0.25, 0.25}}) {
    c.arm.axes[0].lower = lower;
    c.arm.axes[0].upper = upper;
    const auto redundant = recognise_redundant(c.arm);
    for (int trial = 0; trial < 30; ++trial) {
      std::vector<double> q = random_configuration(c.arm, random);
      q[0] = std::clamp(20 * q[0], lower, upper);
      const RedundantSolutions all = solve_redundant(*redundant, pose_of(c, q));
      EXPECT_FALSE(all.out_of_reach);
      EXPECT_FALSE(all.found.empty()) << lower << ' ' << upper << ' ' << q[0];
      for (const RedundantSolution& s : all.found) {
        EXPECT_GE(s.q[0], lower);
        EXPECT_LE(s.q[0], upper);
      }
    }
  }
  // Without limits nothing is out of reach along the rail, and everything across it.
  c.arm.axes[0].lower = -kInfinite;
  c.arm.axes[0].upper = kInfinite;
  const auto redundant = recognise_redundant(c.arm);
  EXPECT_FALSE(solve_redundant(*redundant, {Mat3::Identity(), {0.5, 1e4, 0.5}}).out_of_reach);
  EXPECT_TRUE(solve_redundant(*redundant, {Mat3::Identity(), {5, 0, 0.5}}).out_of_reach);
}

TEST(Redundant, EndlessJointsTakeOthersFar) {
  std::mt19937_64 random(8);
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
  // A beam without end that turns: what turns it moves the arm far.
  const Carried beam = carried(
      "beam",
      {joint(true, z, {-2, 0, 0}, -2, 2), joint(false, x, Vec3::Zero(), -kInfinite, kInfinite)},
      ur5());
  // Two rails that are nearly parallel reach far aside, by going much farther along.
  const Carried rails =
      carried("rails",
              {joint(false, x, Vec3::Zero(), -kInfinite, kInfinite),
               joint(false, Vec3(1, 0.01, 0).normalized(), Vec3::Zero(), -kInfinite, kInfinite)},
              ur5());
  const auto turning = recognise_redundant(beam.arm), sliding = recognise_redundant(rails.arm);
  for (int trial = 0; trial < 30; ++trial) {
    std::vector<double> q = random_configuration(beam.arm, random);
    q[1] *= 10;
    EXPECT_FALSE(solve_redundant(*turning, pose_of(beam, q)).out_of_reach);
    q[0] = -300 - q[1];
    q[1] = 300;
    EXPECT_FALSE(solve_redundant(*sliding, pose_of(rails, q)).out_of_reach);
  }
}

TEST(Redundant, OutsideTheLimitsWhereTheseDoNotCount) {
  Carried c = carried_arms().front();
  const std::vector<double> q{1.2, 0.1, 0.4, 0.7, 0.3, 0.9, -0.2};
  const Transform target = pose_of(c, q);
  for (Axis& axis : c.arm.axes) axis.lower = axis.upper - 1e-3;
  const auto redundant = recognise_redundant(c.arm);
  RedundantOptions options;
  options.reference = q;
  options.limits = false;
  const RedundantSolutions any = solve_redundant(*redundant, target, options);
  ASSERT_FALSE(any.found.empty());
  EXPECT_EQ(any.found.front().q[0], q[0]);
  EXPECT_TRUE(std::ranges::any_of(
      any.found, [&](const RedundantSolution& s) { return turn_distance(s.q.data(), q) < 1e-6; }));
  options.limits = true;
  const RedundantSolutions within = solve_redundant(*redundant, target, options);
  EXPECT_TRUE(within.found.empty());
  EXPECT_FALSE(within.out_of_reach);
}

TEST(Redundant, ManyTurnsOfATorsoAreAllLookedAt) {
  // At the upper of limits of two turns: the values to be found are a turn below.
  Carried c = carried(
      "torso", {joint(true, Vec3::UnitZ(), {-2, 0, 0}, -2 * kHalfCircle, 2 * kHalfCircle)}, ur5());
  const auto redundant = recognise_redundant(c.arm);
  std::vector<double> q(7, 0.3);
  q[0] = kHalfCircle / 2;
  RedundantOptions options;
  options.reference.assign(7, 0.0);
  options.reference[0] = 2 * kHalfCircle;
  const RedundantSolutions all = solve_redundant(*redundant, pose_of(c, q), options);
  EXPECT_FALSE(all.out_of_reach);
  EXPECT_FALSE(all.found.empty());
}

TEST(Redundant, TheSameBitsAndMoreWithMoreValues) {
  const Carried c = carried_arms().back();
  const auto redundant = recognise_redundant(c.arm);
  std::mt19937_64 random(6);
  const Transform target = pose_of(c, random_configuration(c.arm, random));
  RedundantOptions few, many;
  many.values = 40;
  const RedundantSolutions a = solve_redundant(*redundant, target, few),
                           b = solve_redundant(*redundant, target, few),
                           all = solve_redundant(*redundant, target, many);
  ASSERT_EQ(a.found.size(), b.found.size());
  EXPECT_GT(all.found.size(), 3 * a.found.size());
  for (std::size_t i = 0; i < a.found.size(); ++i) {
    EXPECT_EQ(a.found[i].q, b.found[i].q);
    EXPECT_TRUE(std::ranges::any_of(
        all.found, [&](const RedundantSolution& s) { return s.q == a.found[i].q; }));
  }
}

TEST(Redundant, OtherArmsAreNotRecognised) {
  const Arm six = arm_of(ur5());
  EXPECT_FALSE(recognise_redundant(six));
  const Carried c = carried_arms().front();
  Arm other = c.arm;
  std::swap(other.axes[0], other.axes[3]);  // the joint that moves along is within the arm
  EXPECT_FALSE(recognise_redundant(other));
  RedundantOptions options;
  options.reference = {1, 2};
  EXPECT_THROW((void)solve_redundant(*recognise_redundant(c.arm), {}, options), Error);
}

TEST(Redundant, TheRequestSaysWhichAnswerItIs) {
  const Carried c = carried_arms().front();
  InverseRequest request;
  std::mt19937_64 random(7);
  request.target = pose_of(c, random_configuration(c.arm, random));
  const InverseAnswer answer = find_configurations(c.arm, request);
  ASSERT_FALSE(answer.rows.empty());
  EXPECT_EQ(answer.redundant, 1U);
  EXPECT_TRUE(answer.form);
  EXPECT_FALSE(answer.incomplete.empty());
  for (const InverseAnswer::Row& row : answer.rows) {
    EXPECT_TRUE(within_limits(c.arm, row.q));
    EXPECT_EQ(row.free, 1U);
  }
  request.target.translation.x() += 9;
  const InverseAnswer none = find_configurations(c.arm, request);
  EXPECT_TRUE(none.rows.empty());
  EXPECT_TRUE(none.incomplete.empty());
  request.numeric = true;
  EXPECT_FALSE(find_configurations(c.arm, request).incomplete.empty());
}

}  // namespace
}  // namespace kaboum::test
