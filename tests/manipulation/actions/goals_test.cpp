// Configurations for poses that leave a joint free, and at limits: what says that there are no
// others has all.

#include "goals.h"

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>
#include <kaboum/robot/kinematics.h>

#include <cmath>
#include <numbers>
#include <set>

#include "two_arms.h"

namespace kaboum::manipulation {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// Where the hand is, by the judge's kinematics.
world::Transform place_of_hand(const test::TwoArms& arms, const world::RobotModel& robot,
                               const std::vector<double>& q) {
  return judge::places(robot.kinematics, robot.base, q)[arms.hand];
}

Goals goals_at(const test::TwoArms& arms, const world::RobotModel& robot,
               const std::vector<double>& q, unsigned attempt = 0) {
  Goals goals;
  add_goals(goals, robot, arms.hand, place_of_hand(arms, robot, q), robot.home, {1, attempt});
  return goals;
}

/// The wrist 0.7 above the shoulder, on axis 1.
std::vector<double> wrist_on_axis() {
  const double upper = 0.5, fore = 0.45, height = 0.7;
  const double elbow =
      std::acos((height * height - upper * upper - fore * fore) / (2 * upper * fore));
  const double lean = -std::atan2(fore * std::sin(elbow), upper + fore * std::cos(elbow));
  return {0.4, lean, elbow, 0.3, 0.9, -0.2};
}

TEST(Goals, AWristOnTheFirstAxisIsTriedAllAround) {
  const test::TwoArms arms;
  const world::RobotModel& robot = arms.world.robots[0];
  const std::vector<double> q = wrist_on_axis();
  const world::Transform target = place_of_hand(arms, robot, q);
  const Goals goals = goals_at(arms, robot, q);
  EXPECT_FALSE(goals.all) << "joint 1 is free";
  EXPECT_TRUE(goals.alone);
  std::set<int> turns;
  for (const std::vector<double>& goal : goals.configurations) {
    EXPECT_FALSE(robot::find_out_of_limits(robot.kinematics, goal));
    const world::Transform at = place_of_hand(arms, robot, goal);
    EXPECT_LT((at.translation - target.translation).norm(), 1e-7);
    EXPECT_LT((at.linear - target.linear).norm(), 1e-7);
    turns.insert(static_cast<int>(std::floor(goal[0] / 0.5)));
  }
  EXPECT_GE(turns.size(), 8U) << "the range is 5.8";
  EXPECT_GT(goals_at(arms, robot, q, 2).configurations.size(), 2 * goals.configurations.size());
}

TEST(Goals, AFamilyOutsideTheLimitsIsProvedToBe) {
  const test::TwoArms arms;
  world::RobotModel robot = arms.world.robots[0];
  const std::vector<double> q = wrist_on_axis();
  // The elbow is bent by ±q[2] whatever joint 1 does.
  robot.kinematics.variables[2].lower = -0.5 * q[2];
  robot.kinematics.variables[2].upper = 0.5 * q[2];
  robot.home[2] = 0;
  Goals goals = goals_at(arms, robot, q);
  EXPECT_TRUE(goals.configurations.empty());
  EXPECT_TRUE(goals.all);
  // What touches the limit is there.
  robot.kinematics.variables[2].upper = q[2];
  goals = goals_at(arms, robot, q);
  EXPECT_FALSE(goals.all);
}

TEST(Goals, AlignedAxesLeaveAJointFree) {
  const test::TwoArms arms;
  const world::RobotModel& robot = arms.world.robots[1];
  const Goals goals = goals_at(arms, robot, {0.2, -0.3, 1.5, 0.7, 0, 0.4});
  EXPECT_FALSE(goals.all);
  EXPECT_GE(goals.configurations.size(), 20U);
  EXPECT_TRUE(goals_at(arms, robot, {0.2, -0.3, 1.5, 0.7, 0.8, 0.4}).all);
}

TEST(Goals, RoundingDoesNotTakeAConfigurationPastItsLimit) {
  const test::TwoArms arms;
  world::RobotModel robot = arms.world.robots[0];
  const std::vector<double> q{kQuarter, -0.3, 1.5, 0.7, 0.8, 0.4};  // the word is 1.570796327
  robot.kinematics.variables[0].upper = kQuarter;
  robot.kinematics.variables[0].lower = kQuarter - 0.1;
  robot.home[0] = kQuarter - 0.05;
  const Goals goals = goals_at(arms, robot, q);
  bool seen = false;
  for (const std::vector<double>& goal : goals.configurations) {
    EXPECT_LE(goal[0], kQuarter);
    seen = seen || std::abs(goal[0] - kQuarter) < 1e-8;
  }
  EXPECT_TRUE(seen);
}

TEST(Goals, AnArmOnARailMovesAlongIt) {
  const test::TwoArms arms;
  const world::RobotModel robot = test::on_rail(arms.world.robots[0], -1.5, 1.5);
  const std::uint32_t hand = arms.hand + 1;
  const auto at = [&](const std::vector<double>& q) {
    return judge::places(robot.kinematics, robot.base, q)[hand];
  };
  std::vector<double> q = robot.home;
  q.back() = 1.4;  // what the arm reaches from one end of the rail is out of its reach at the other
  const world::Transform target = at(q);
  std::vector<double> from = robot.home;
  from.back() = -1.5;
  Goals goals;
  add_goals(goals, robot, hand, target, from, {1, 0});
  EXPECT_FALSE(goals.all);
  EXPECT_TRUE(goals.alone);
  ASSERT_FALSE(goals.configurations.empty());
  std::set<int> places;
  for (const std::vector<double>& goal : goals.configurations) {
    EXPECT_FALSE(robot::find_out_of_limits(robot.kinematics, goal));
    EXPECT_LT((at(goal).translation - target.translation).norm(), 1e-7);
    EXPECT_LT((at(goal).linear - target.linear).norm(), 1e-7);
    places.insert(static_cast<int>(std::floor(goal.back() / 0.05)));
  }
  EXPECT_GE(places.size(), 5U);
  Goals more;
  add_goals(more, robot, hand, target, from, {1, 3});
  EXPECT_GT(more.configurations.size(), 3 * goals.configurations.size());
  // Out of reach along the rail, and that is proved.
  world::Transform far = target;
  far.translation += robot.base.linear * world::Vec3(0, 4, 0);
  Goals none;
  add_goals(none, robot, hand, far, from, {1, 0});
  EXPECT_TRUE(none.configurations.empty());
  EXPECT_TRUE(none.all);
}

TEST(Goals, OtherJointsMayMakeRoom) {
  const test::TwoArms arms;
  world::RobotModel robot = arms.world.robots[0];
  robot::Robot& kinematics = robot.kinematics;
  robot::Joint finger = kinematics.joints.back();
  finger.name = "finger";
  finger.parent = arms.hand;
  finger.variable = static_cast<std::uint32_t>(kinematics.variables.size());
  kinematics.joints.push_back(finger);
  kinematics.links.push_back({});
  kinematics.links.back().name = "finger";
  kinematics.variables.push_back(kinematics.variables.back());
  kinematics.variables.back().name = "finger";
  robot.home.push_back(0);
  std::vector<double> q{0.2, -0.3, 1.5, 0.7, 0.8, 0.4, 0};
  const Goals goals = goals_at(arms, robot, q);
  EXPECT_TRUE(goals.all) << "they reach nothing else";
  EXPECT_FALSE(goals.alone);
}

}  // namespace
}  // namespace kaboum::manipulation
