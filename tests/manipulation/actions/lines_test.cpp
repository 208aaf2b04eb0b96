// Straight lines of a tool, by kinematics of the judge's own.

#include "lines.h"

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>

#include <random>

#include "two_arms.h"

namespace kaboum::manipulation {
namespace {

TEST(FollowLine, LeadsTheLinkAlongAStraightLine) {
  const test::TwoArms arms;
  const world::RobotModel& robot = arms.world.robots[0];
  const auto at = [&](const std::vector<double>& q) {
    return judge::places(robot.kinematics, robot.base, q)[arms.hand];
  };
  const geom::Transform start = at(robot.home);
  for (const geom::Vec3& by :
       {geom::Vec3(0, 0, 0.1), geom::Vec3(0.05, -0.1, 0), geom::Vec3(0, 0.2, 0)}) {
    geom::Transform end = start;
    end.translation += by;
    const auto path = follow_line(robot, arms.hand, robot.home, end, 0.01);
    ASSERT_TRUE(path);
    EXPECT_GE(path->size(), static_cast<std::size_t>(by.norm() / 0.01));
    for (const std::vector<double>& q : *path) {
      const geom::Transform pose = at(q);
      const geom::Vec3 gone = pose.translation - start.translation;
      const double along = gone.dot(by.normalized());
      EXPECT_LT((gone - along * by.normalized()).norm(), 1e-8);
      EXPECT_GT(along, -1e-8);
      EXPECT_LT(along, by.norm() + 1e-8);
      EXPECT_LT((pose.linear - start.linear).cwiseAbs().maxCoeff(), 1e-8);
    }
    EXPECT_LT((at(path->back()).translation - end.translation).norm(), 1e-8);
  }
  geom::Transform far = start;
  far.translation.x() += 2;
  EXPECT_FALSE(follow_line(robot, arms.hand, robot.home, far, 0.01));
}

TEST(FollowLine, KeepsTheRailWhereItCanAndMovesAlongItElsewhere) {
  const test::TwoArms arms;
  const world::RobotModel robot = test::on_rail(arms.world.robots[0], -1.5, 1.5);
  const std::uint32_t hand = arms.hand + 1;
  const auto at = [&](const std::vector<double>& q) {
    return judge::places(robot.kinematics, robot.base, q)[hand];
  };
  const geom::Transform start = at(robot.home);
  for (const double length : {0.1, 1.5}) {
    geom::Transform end = start;
    end.translation += robot.base.linear * geom::Vec3(0, length, 0);
    const auto path = follow_line(robot, hand, robot.home, end, 0.02);
    ASSERT_TRUE(path) << length;
    EXPECT_LT((at(path->back()).translation - end.translation).norm(), 1e-8);
    EXPECT_LT((at(path->back()).linear - start.linear).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_EQ(path->back().back() == robot.home.back(), length < 1) << length;
  }
}

}  // namespace
}  // namespace kaboum::manipulation
