// Paths that stay upright, against the largest angle among many samples of kinematics of the
// judge's own.

#include "lines.h"

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>

#include <random>

#include "two_arms.h"

namespace kaboum::manipulation {
namespace {

/// How far a link's direction leans, at most, among samples.
double most_lean(const world::RobotModel& robot, const robot::Path& path, const Upright& upright,
                 double step) {
  double most = 0;
  for (const std::vector<double>& q : test::samples_of(path, step)) {
    const geom::Vec3 up =
        judge::places(robot.kinematics, robot.base, q)[upright.link].linear * upright.up;
    most = std::max(most, std::atan2(std::hypot(up.x(), up.y()), up.z()));
  }
  return most;
}

TEST(StaysUpright, AgreesWithTheLargestAngleOfManySamples) {
  const test::TwoArms arms;
  const world::RobotModel& robot = arms.world.robots[1];
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  int stays = 0, leans = 0, barely = 0;
  for (int i = 0; i < 400; ++i) {
    robot::Path path{robot.home};
    const double size = 0.02 + 0.5 * unit(random);
    for (int w = 0; w < 3; ++w) {
      std::vector<double> q = path.back();
      for (double& x : q) x += size * normal(random);
      path.push_back(std::move(q));
    }
    // What is vertical somewhere on the way.
    const std::vector<double>& at = path[static_cast<std::size_t>(4 * unit(random))];
    Upright upright;
    upright.link = arms.hand;
    upright.up = judge::places(robot.kinematics, robot.base, at)[arms.hand].linear.transpose() *
                 geom::Vec3::UnitZ();
    const double most = most_lean(robot, path, upright, 1e-3);
    // Just above, just below, and at random.
    for (const double angle : {most + 3e-3, most - 3e-3, 3 * unit(random)}) {
      if (!(angle > 0)) continue;
      upright.angle = angle;
      const bool answer = stays_upright(robot, path, upright);
      if (answer) {
        EXPECT_LE(most, angle) << i;
      } else {
        EXPECT_GT(most, angle - 2e-3) << i;  // the samples may miss the largest
      }
      ++(answer ? stays : leans);
      barely += std::abs(most - angle) < 4e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(stays, 400);
  EXPECT_GT(leans, 400);
  EXPECT_GT(barely, 600);
}

TEST(StaysUpright, SeesWhatIsBetweenWaypointsAlone) {
  // The wrist turns over and back in one segment of the forearm's: the ends are upright.
  const test::TwoArms arms;
  const world::RobotModel& robot = arms.world.robots[0];
  const std::vector<double>&home = robot.home, turned = {0, -0.3, 1.5, 2, 1.2, 0};
  Upright upright{arms.hand,
                  judge::places(robot.kinematics, robot.base, home)[arms.hand].linear.transpose() *
                      geom::Vec3::UnitZ(),
                  0.2};
  EXPECT_TRUE(stays_upright(robot, {home, home}, upright));
  EXPECT_FALSE(stays_upright(robot, {home, turned, home}, upright));
  std::vector<double> past = home;
  past[3] = -2;
  EXPECT_FALSE(stays_upright(robot, {turned, past}, upright));
  upright.angle = most_lean(robot, {turned, past}, upright, 1e-4) + 1e-4;
  EXPECT_TRUE(stays_upright(robot, {turned, past}, upright));
}

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

}  // namespace
}  // namespace kaboum::manipulation
