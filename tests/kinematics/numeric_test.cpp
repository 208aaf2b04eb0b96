#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/kinematics/numeric.h>

#include <cmath>
#include <numbers>

#include "arms.h"
#include "robots.h"

namespace kaboum::test {
namespace {

DhArm seven_axes() {
  const double quarter = std::numbers::pi / 2;
  DhArm arm;
  arm.rows = {{0, .34, 0, -quarter}, {0, 0, 0, quarter}, {0, .4, 0, quarter}, {0, 0, 0, -quarter},
              {0, .4, 0, -quarter},  {0, 0, 0, quarter}, {0, .126, 0, 0}};
  return arm;
}

Arm limited(Arm arm, double limit) {
  for (Axis& axis : arm.axes) {
    axis.lower = -limit;
    axis.upper = limit;
  }
  return arm;
}

TEST(Numeric, FindsConfigurationsWithinTheLimits) {
  std::mt19937_64 random(1);
  for (const DhArm& dh : {rv_6sl(true), seven_axes()}) {
    const Arm arm = limited(arm_of(dh), 2);
    int found = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const Transform target = reference_pose(dh, random_joints(random, dh.rows.size(), 2));
      const auto s = solve_numeric(arm, target);
      if (!s) continue;
      ++found;
      const PoseError error = difference(reference_pose(dh, s->q), target);
      EXPECT_LT(error.position, 1.5e-10);
      EXPECT_LT(error.rotation, 1.5e-10);
      EXPECT_TRUE(within_limits(arm, s->q));
    }
    EXPECT_GE(found, 98);
  }
}

TEST(Numeric, JointsThatMoveAlong) {
  const Arm arm = kinematics::arm_of(prismatic_chain().robot, "base", "link 5");
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 30; ++trial) {
    const Transform target = kinematics::forward(arm, random_joints(random, 5, 0.8));
    const auto s = solve_numeric(arm, target);
    ASSERT_TRUE(s) << trial;
    EXPECT_LT(difference(kinematics::forward(arm, s->q), target).position, 1e-9);
  }
}

TEST(Numeric, TheSameArgumentsGiveTheSameBits) {
  const Arm arm = limited(arm_of(seven_axes()), 2.5);
  const Transform target = kinematics::forward(arm, std::vector<double>{1, .5, -1, 1.5, .2, 1, -1});
  NumericOptions options;
  options.seed = 7;
  const auto a = solve_numeric(arm, target, options), b = solve_numeric(arm, target, options);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->q, b->q);
  options.seed = 8;
  const auto c = solve_numeric(arm, target, options);
  ASSERT_TRUE(c);
  EXPECT_NE(a->q, c->q);
}

TEST(Numeric, StartsWhereItIsTold) {
  const Arm arm = limited(arm_of(seven_axes()), 2.5);
  const std::vector<double> q{1, .5, -1, 1.5, .2, 1, -1};
  NumericOptions options;
  options.first = q;
  const auto s = solve_numeric(arm, kinematics::forward(arm, q), options);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->q, q);
  EXPECT_EQ(s->starts, 1);
  options.first.pop_back();
  EXPECT_THROW(solve_numeric(arm, {}, options), Error);
}

TEST(Numeric, EndsWithAsManySolutionsAsAreAskedFor) {
  const Arm arm = limited(arm_of(seven_axes()), 2.5);
  const Transform target = kinematics::forward(arm, std::vector<double>{1, .5, -1, 1.5, .2, 1, -1});
  NumericOptions options;
  const auto all = solve_numeric_all(arm, target, options);
  ASSERT_GT(all.size(), 5U);
  options.solutions = 5;
  const auto few = solve_numeric_all(arm, target, options);
  ASSERT_EQ(few.size(), 5U);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].q, all[i].q);
}

TEST(Numeric, NothingOutOfReach) {
  const Arm arm = limited(arm_of(rv_6sl(true)), 3);
  Transform target;
  target.translation = {2, 0, 0};
  EXPECT_FALSE(solve_numeric(arm, target));
}

TEST(Numeric, FindsWhatTheClosedFormHas) {
  std::mt19937_64 random(3);
  const DhArm dh = rv_6sl(true);
  const Arm arm = limited(arm_of(dh), std::numbers::pi);
  const auto form = recognise(arm);
  ASSERT_TRUE(form);
  NumericOptions options;
  options.starts = 150;
  std::size_t missed = 0, all = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const Transform target = reference_pose(dh, random_joints(random, 6, 3));
    const Solutions closed = solve(*form, target);
    const auto numeric = solve_numeric_all(arm, target, options);
    for (const NumericSolution& s : numeric) {
      double nearest = 10;
      for (const Solution& c : closed) nearest = std::min(nearest, turn_distance(c.q.data(), s.q));
      EXPECT_LT(nearest, 1e-6);
    }
    EXPECT_LE(numeric.size(), closed.size());
    missed += closed.size() - numeric.size();
    all += closed.size();
  }
  EXPECT_LT(missed, all / 10);
}

}  // namespace
}  // namespace kaboum::test
