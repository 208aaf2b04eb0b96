#include <gtest/gtest.h>
#include <kaboum/kinematics/copies.h>

#include <cmath>
#include <numbers>

#include "arms.h"

namespace kaboum::test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Arm limited(const std::vector<std::pair<double, double>>& limits) {
  Arm arm;
  for (const auto& [lower, upper] : limits) {
    Axis axis;
    axis.lower = lower;
    axis.upper = upper;
    arm.axes.push_back(axis);
  }
  return arm;
}

TEST(Copies, AllWholeTurnsWithinTheLimits) {
  const Arm arm = limited({{-kTurn, kTurn}, {-1, 1}, {-2 * kTurn, 0}});
  const std::vector<double> q{0.5, 0.25, -0.5};
  const auto all = copies(arm, q);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(count_copies(arm, q), 4);
  EXPECT_NEAR(all[0][0], 0.5 - kTurn, 1e-15);
  EXPECT_NEAR(all[0][2], -0.5 - kTurn, 1e-14);
  for (const auto& c : all) EXPECT_TRUE(within_limits(arm, c));
  EXPECT_EQ(copies(arm, q, 3).size(), 3U);
}

TEST(Copies, TheNearestToAReference) {
  const Arm arm = limited({{-kTurn, kTurn}, {-1, 1}});
  const auto near =
      nearest_copy(arm, std::vector<double>{0.5, 0.25 + kTurn}, std::vector<double>{-6, 100});
  ASSERT_TRUE(near);
  EXPECT_NEAR((*near)[0], 0.5 - kTurn, 1e-14);
  EXPECT_NEAR((*near)[1], 0.25, 1e-14);
  EXPECT_FALSE(nearest_copy(arm, std::vector<double>{0.5, 2}, std::vector<double>{0, 0}));
}

TEST(Copies, WhatIsRoundedPastALimitIsOnIt) {
  const Arm arm = limited({{-1, 1}});
  const auto on = nearest_copy(arm, std::vector<double>{1 + 1e-13}, std::vector<double>{0});
  ASSERT_TRUE(on);
  EXPECT_EQ((*on)[0], 1);
  EXPECT_FALSE(nearest_copy(arm, std::vector<double>{1 + 1e-10}, std::vector<double>{0}));
}

TEST(Copies, JointsWithoutLimitsTakeOneValue) {
  const double infinite = std::numeric_limits<double>::infinity();
  const Arm arm = limited({{-infinite, infinite}, {3, infinite}});
  const auto all = copies(arm, std::vector<double>{1 + kTurn, 0.5});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_NEAR(all[0][0], 1, 1e-14);
  EXPECT_NEAR(all[0][1], 0.5 + kTurn, 1e-14);
}

TEST(Copies, JointsThatMoveAlongHaveNoTurns) {
  Arm arm = limited({{-20, 20}});
  arm.axes[0].turns = false;
  EXPECT_EQ(copies(arm, std::vector<double>{0.5}).size(), 1U);
  EXPECT_TRUE(copies(arm, std::vector<double>{21}).empty());
}

}  // namespace
}  // namespace kaboum::test
