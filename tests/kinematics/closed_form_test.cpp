#include <gtest/gtest.h>
#include <kaboum/kinematics/copies.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "arms.h"

namespace kaboum::test {
namespace {

/// Fails unless all solutions reach the pose by the reference's kinematics and are different ones.
/// @return how near the nearest is to q.
double check_solutions(const DhArm& dh, const ClosedForm& form, const std::vector<double>& q) {
  const Transform target = reference_pose(dh, q);
  const Solutions found = solve(form, target);
  double nearest = 100;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::vector<double> s(found[i].q.begin(), found[i].q.begin() + q.size());
    const PoseError error = difference(reference_pose(dh, s), target);
    EXPECT_LE(error.position, found[i].position_error + 1e-14);
    EXPECT_LE(error.rotation, found[i].rotation_error + 1e-14);
    EXPECT_LT(error.position + error.rotation, 1e-9);
    for (const double value : s) EXPECT_LE(std::abs(value), std::numbers::pi);
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT(turn_distance(found[k].q.data(), s), 1e-9);
    nearest = std::min(nearest, turn_distance(s.data(), q));
  }
  return nearest;
}

class Families : public testing::TestWithParam<Family> {};

TEST_P(Families, EverySolutionReachesThePoseAndNoneIsMissed) {
  std::mt19937_64 random(1);
  const std::size_t n = GetParam() == Family::FiveAxes ? 5 : 6;
  std::size_t all = 0, poses = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const DhArm dh = random_arm(GetParam(), random);
    const auto form = recognise(arm_of(dh));
    ASSERT_TRUE(form) << trial;
    EXPECT_EQ(form->family, GetParam());
    EXPECT_LT(form->model_error.position, 1e-13);
    EXPECT_LT(form->model_error.rotation, 1e-13);
    for (int pose = 0; pose < 25; ++pose) {
      const std::vector<double> q = random_joints(random, n, std::numbers::pi);
      EXPECT_LT(check_solutions(dh, *form, q), 1e-5) << trial << ' ' << pose;
      all += solve(*form, reference_pose(dh, q)).size();
      ++poses;
    }
  }
  // Random poses have most of the branches.
  EXPECT_GT(static_cast<double>(all) / static_cast<double>(poses), n == 6 ? 5 : 2);
}

TEST_P(Families, WhatIsLeftOutIsOutsideTheLimitsAndAllOfThat) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const std::size_t n = GetParam() == Family::FiveAxes ? 5 : 6;
  std::size_t kept = 0, left = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    Arm arm = arm_of(random_arm(GetParam(), random));
    for (Axis& axis : arm.axes) {
      axis.lower = 5 * unit(random);  // some limits have nothing but whole turns apart
      axis.upper = axis.lower + 3 + 2 * unit(random);
    }
    const auto form = recognise(arm);
    ASSERT_TRUE(form);
    const std::vector<double> q = random_joints(random, n, std::numbers::pi);
    const Transform target = kinematics::forward(arm, q);
    SolveOptions options;
    options.leave_outside = true;
    const Solutions all = solve(*form, target), within = solve(*form, target, options);
    std::vector<Joints> expected, got;
    for (const Solution& s : all)
      if (nearest_copy(arm, {s.q.data(), n}, q)) expected.push_back(s.q);
    for (const Solution& s : within) got.push_back(s.q);
    EXPECT_EQ(got, expected);
    EXPECT_TRUE(within.left_outside || within.size() == all.size());
    EXPECT_FALSE(all.left_outside);
    kept += within.size();
    left += all.size() - within.size();
  }
  EXPECT_GT(kept, 15U);
  EXPECT_GT(left, 100U);
}

INSTANTIATE_TEST_SUITE_P(ClosedForm, Families,
                         testing::Values(Family::SphericalWrist, Family::ParallelAxes,
                                         Family::FiveAxes));

TEST(ClosedForm, BothConventionsGiveTheSameSolutions) {
  std::mt19937_64 random(2);
  const DhArm distal = rv_6sl(true), proximal = rv_6sl(false);
  const auto a = recognise(arm_of(distal)), b = recognise(arm_of(proximal));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->family, Family::SphericalWrist);
  EXPECT_NEAR(a->a1, .085, 1e-15);
  EXPECT_NEAR(a->a2, .38, 1e-15);
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<double> q = random_joints(random, 6, 3);
    const Transform target = reference_pose(distal, q);
    EXPECT_LT(difference(target, reference_pose(proximal, q)).position, 1e-15);
    const Solutions x = solve(*a, target), y = solve(*b, target);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_LT(turn_distance(x[i].q.data(), {y[i].q.begin(), y[i].q.end()}), 1e-7);
  }
}

TEST(ClosedForm, AnAlignedWristKeepsTheReference) {
  const DhArm dh = rv_6sl(true);
  const auto form = recognise(arm_of(dh));
  ASSERT_TRUE(form);
  const std::vector<double> q{0.3, 0.4, 1.2, 0.7, 0, -0.2};  // axes 4 and 6 on one line
  SolveOptions options;
  options.reference = {0, 0, 0, 1.25, 0, 0};
  const Transform target = reference_pose(dh, q);
  bool seen = false;
  for (const Solution& s : solve(*form, target, options)) {
    EXPECT_LT(difference(reference_pose(dh, {s.q.begin(), s.q.end()}), target).position, 1e-10);
    if ((s.singular & kWrist) == 0) continue;
    seen = true;
    EXPECT_NEAR(s.q[3], 1.25, 1e-15);
    EXPECT_NEAR(s.q[3] + s.q[5], 0.5, 1e-9);
  }
  EXPECT_TRUE(seen);
}

TEST(ClosedForm, AnAlignedAxisOfParallelAxesKeepsTheReference) {
  std::mt19937_64 random(8);
  int count = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const DhArm dh = random_arm(Family::ParallelAxes, random);
    const auto form = recognise(arm_of(dh));
    ASSERT_TRUE(form);
    std::vector<double> q = random_joints(random, 6, 3);
    q[4] = form->sign[4] * (0 - form->offset[4]);  // axis 6 is parallel to axes 2 to 4
    SolveOptions options;
    options.reference = {0, 0, 0, 0, 0, 0.75};
    const Transform target = reference_pose(dh, q);
    bool seen = false;
    for (const Solution& s : solve(*form, target, options)) {
      EXPECT_LT(difference(reference_pose(dh, {s.q.begin(), s.q.end()}), target).position, 1e-9);
      if ((s.singular & kWrist) == 0) continue;
      seen = true;
      EXPECT_NEAR(s.q[5], 0.75, 1e-15);
    }
    // The reference may be out of reach for the elbow; the configuration's own value is not.
    options.reference[5] = q[5];
    double nearest = 10;
    for (const Solution& s : solve(*form, target, options))
      nearest = std::min(nearest, turn_distance(s.q.data(), q));
    EXPECT_LT(nearest, 1e-5);
    count += seen;
  }
  EXPECT_GT(count, 20);
}

TEST(ClosedForm, FiveAxesAboveTheFirstAxisTakeTheDirection) {
  // Without lengths to the side: the end is on axis 1 when the arm goes straight up and back.
  DhArm dh;
  const double quarter = std::numbers::pi / 2;
  dh.rows = {
      {0, .2, 0, quarter}, {0, 0, .19, 0}, {0, 0, .139, 0}, {0, 0, 0, quarter}, {0, 0, 0, 0}};
  const auto form = recognise(arm_of(dh));
  ASSERT_TRUE(form);
  EXPECT_EQ(form->family, Family::FiveAxes);
  const double lift = 1.1;  // the end of two links over the shoulder
  const double fold = std::asin(.19 * std::cos(lift) / .139);
  const std::vector<double> q{0.4, lift, quarter + fold - lift, 0.5, -0.3};
  ASSERT_NEAR(reference_pose(dh, q).translation.head<2>().norm(), 0, 1e-12);
  EXPECT_LT(check_solutions(dh, *form, q), 1e-6);
}

TEST(ClosedForm, AWristOnTheFirstAxisKeepsTheReference) {
  DhArm dh;  // a1 = 0, lateral = 0: straight up, the wrist is on axis 1
  const double quarter = std::numbers::pi / 2;
  dh.rows = {{0, .3, 0, -quarter}, {0, 0, .5, 0},      {0, 0, 0, -quarter},
             {0, .4, 0, quarter},  {0, 0, 0, quarter}, {0, .1, 0, 0}};
  const auto form = recognise(arm_of(dh));
  ASSERT_TRUE(form);
  for (const double bend : {0.6, 0.0}) {
    // Two links of 0.5 and 0.4 whose end is on the axis above the shoulder, bent and stretched.
    const double c = std::cos(bend), s = std::sin(bend);
    const std::vector<double> q{
        0.4, -quarter - std::atan2(0.4 * s, 0.5 + 0.4 * c), bend - quarter, 0.3, 0.9, 0.1};
    SolveOptions options;
    options.reference = {-1.1, 0, 0, 0, 0, 0};
    const Transform target = reference_pose(dh, q);
    const Solutions found = solve(*form, target, options);
    EXPECT_FALSE(found.empty());
    for (const Solution& x : found) {
      EXPECT_TRUE(x.singular & kShoulder);
      EXPECT_NEAR(x.q[0], -1.1, 1e-15);
      EXPECT_LT(difference(reference_pose(dh, {x.q.begin(), x.q.end()}), target).position, 1e-9);
    }
  }
}

TEST(ClosedForm, AStretchedArmIsFoundAndFlagged) {
  std::mt19937_64 random(3);
  std::size_t flagged = 0;
  for (int trial = 0; trial < 200; ++trial) {
    DhArm dh = random_arm(Family::ParallelAxes, random);
    const auto form = recognise(arm_of(dh));
    ASSERT_TRUE(form);
    std::vector<double> q = random_joints(random, 6, 3);
    q[2] = form->sign[2] * (0 - form->offset[2]);
    const double nearest = check_solutions(dh, *form, q);
    EXPECT_LT(nearest, 1e-4) << trial;
    for (const Solution& s : solve(*form, reference_pose(dh, q)))
      flagged += (s.singular & kElbow) != 0;
  }
  EXPECT_GT(flagged, 20U);  // others are stretched up to rounding
}

TEST(ClosedForm, PosesOutOfReachHaveNone) {
  const DhArm dh = rv_6sl(true);
  const auto form = recognise(arm_of(dh));
  ASSERT_TRUE(form);
  Transform target;
  target.translation = {2, 0, 0};
  EXPECT_TRUE(solve(*form, target).empty());
  target.translation = {0.2, 0, -0.7};
  EXPECT_TRUE(solve(*form, target).empty());
}

TEST(ClosedForm, FiveAxesReachOtherPosesWithAnotherHeading) {
  std::mt19937_64 random(12);
  int unreached = 0, most = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const DhArm dh = random_arm(Family::FiveAxes, random);
    const auto form = recognise(arm_of(dh));
    ASSERT_TRUE(form);
    const std::vector<double> q = random_joints(random, 5, std::numbers::pi);
    const Transform reached = reference_pose(dh, q);
    // Axis 1 in the base's frame, from the arm itself.
    const Vec3 up = arm_of(dh).axes[0].direction;
    const double heading = random_joints(random, 1, 3)[0];
    const Transform target{robot::rotation_about(up, heading) * reached.linear,
                           reached.translation};
    unreached += solve(*form, target).empty() ? 1 : 0;
    int solutions = 0;
    double nearest = 100;
    for (const Transform& pose : with_other_headings(*form, target)) {
      EXPECT_LT((pose.translation - target.translation).norm(), 1e-12 * form->reach);
      // Only turned about axis 1's direction.
      EXPECT_LT((pose.linear * target.linear.transpose() * up - up).norm(), 1e-12);
      for (const Solution& s : solve(*form, pose)) {
        const std::vector<double> found(s.q.begin(), s.q.begin() + 5);
        const PoseError error = difference(reference_pose(dh, found), pose);
        EXPECT_LT(error.position + error.rotation, 1e-9);
        nearest = std::min(nearest, turn_distance(found.data(), q));
        ++solutions;
      }
    }
    EXPECT_LT(nearest, 1e-5) << trial;
    most = std::max(most, solutions);
  }
  EXPECT_GT(unreached, 270);
  EXPECT_GT(most, 3);
  EXPECT_TRUE(with_other_headings(*recognise(arm_of(rv_6sl(true))), Transform{}).empty());
}

TEST(ClosedForm, FiveAxesRefuseOtherDirections) {
  std::mt19937_64 random(4);
  const DhArm dh = random_arm(Family::FiveAxes, random);
  const auto form = recognise(arm_of(dh));
  ASSERT_TRUE(form);
  Transform target = reference_pose(dh, random_joints(random, 5, 2));
  EXPECT_FALSE(solve(*form, target).empty());
  // Turned about what would be a sixth axis.
  target.linear = target.linear * robot::rotation_about(Vec3(1, 2, 3).normalized(), 0.01);
  EXPECT_TRUE(solve(*form, target).empty());
}

TEST(ClosedForm, OtherArmsAreNotRecognised) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 100; ++trial) {
    Arm arm = arm_of(random_arm(Family::SphericalWrist, random));
    arm.axes[3].point += 0.1 * arm.axes[4].direction;  // axes 4 and 6 miss each other
    EXPECT_FALSE(recognise(arm));
    DhArm dh = random_arm(Family::ParallelAxes, random);
    dh.rows[1].alpha += 0.1;
    EXPECT_FALSE(recognise(arm_of(dh)));
  }
  Arm slides = arm_of(rv_6sl(true));
  slides.axes[2].turns = false;
  EXPECT_FALSE(recognise(slides));
}

/// An arm whose axes are off by about `size`.
Arm disturbed(Arm arm, std::mt19937_64& random, double size) {
  std::normal_distribution<double> normal(0, size);
  for (Axis& axis : arm.axes) {
    axis.direction =
        (axis.direction + Vec3(normal(random), normal(random), normal(random))).normalized();
    axis.point += Vec3(normal(random), normal(random), normal(random));
  }
  return arm;
}

TEST(ClosedForm, TheModelIsNowhereFartherOffThanItSays) {
  std::mt19937_64 random(6);
  double tightest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Arm arm = disturbed(arm_of(rv_6sl(true)), random, 1e-5);
    const auto form = recognise(arm);
    ASSERT_TRUE(form);
    // The model alone: solutions of it that are not improved.
    SolveOptions loose;
    loose.bound = 1;
    for (int pose = 0; pose < 50; ++pose) {
      const std::vector<double> q = random_joints(random, 6, 3);
      const Transform target = forward(arm, q);
      for (const Solution& s : solve(*form, target, loose)) {
        const PoseError error = difference(forward(arm, s.q), target);
        EXPECT_LE(error.position, s.position_error);
        EXPECT_LE(error.rotation, s.rotation_error);
        tightest = std::max(tightest, error.position / s.position_error);
      }
    }
  }
  EXPECT_GT(tightest, 0.05);  // it is no idle bound
}

TEST(ClosedForm, ArmsNearAFamilyAreSolvedOnThemselves) {
  std::mt19937_64 random(7);
  std::size_t found = 0, poses = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Arm arm = disturbed(arm_of(rv_6sl(true)), random, 1e-5);
    const auto form = recognise(arm);
    ASSERT_TRUE(form);
    for (int pose = 0; pose < 20; ++pose) {
      const std::vector<double> q = random_joints(random, 6, 3);
      const Transform target = forward(arm, q);
      double nearest = 100;
      for (const Solution& s : solve(*form, target)) {
        const PoseError error = difference(forward(arm, s.q), target);
        EXPECT_LT(error.position + error.rotation, 3e-9);
        nearest = std::min(nearest, turn_distance(s.q.data(), q));
      }
      found += nearest < 1e-5;
      ++poses;
    }
  }
  EXPECT_GT(found, poses * 97 / 100);  // not near singular configurations
}

}  // namespace
}  // namespace kaboum::test
