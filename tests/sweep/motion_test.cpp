#include <gtest/gtest.h>
#include <kaboum/sweep/motion.h>

#include <cmath>

#include "sampling.h"

namespace kaboum::test {
namespace {

TEST(Motion, PosesAgreeWithTheReferenceWithinTheStatedError) {
  std::mt19937_64 random(2);
  for (const TestRobot& r : test_robots()) {
    for (int trial = 0; trial < 30; ++trial) {
      const Path path = random_path(r.robot, random, 2, 3, trial % 2 == 0);
      for (const LinkBody& body : r.bodies) {
        const LinkMotion motion(r.robot, body.link, path[0], path[1]);
        const MotionBounds bounds(motion, body.points);
        for (const double s : {0.0, 0.3, 1.0}) {
          const Transform expected =
              reference_pose(r.robot, body.link, between(path[0], path[1], s));
          const Transform got = motion.at(s), expanded = motion.expand(s)[0];
          for (const Vec3& p : body.points) {
            EXPECT_LE((got * p - expected * p).norm(), bounds.error(0)) << r.name;
            EXPECT_LE((expanded * p - expected * p).norm(), bounds.error(0)) << r.name;
            EXPECT_LE(got.translation.norm(), bounds.extent() + 1e-12);
            EXPECT_LE((got * p).norm(), bounds.extent());
          }
        }
      }
    }
  }
}

TEST(Motion, TaylorCoefficientsAreThoseOfTheMotion) {
  std::mt19937_64 random(3);
  for (const TestRobot& r : {six_axis_arm(), prismatic_chain()}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Path path = random_path(r.robot, random, 2, 1.5, trial % 2 == 0);
      const LinkBody& body = r.bodies.back();
      const LinkMotion motion(r.robot, body.link, path[0], path[1]);
      const MotionBounds bounds(motion, body.points);
      const double s = 0.4;
      const auto c = motion.expand(s);
      for (const double t : {-0.1, 0.05, 0.15}) {
        const Transform exact =
            reference_pose(r.robot, body.link, between(path[0], path[1], s + t));
        for (const Vec3& p : body.points) {
          Vec3 sum = c[0] * p;
          double power = 1;
          for (int n = 1; n <= LinkMotion::kOrder; ++n) {
            power *= t;
            sum += power * (c[n] * p);
          }
          EXPECT_LE((exact * p - sum).norm(), bounds.derivative(6) * std::pow(t, 6) / 720 + 1e-14)
              << r.name;
          EXPECT_LE(120 * (c[5] * p).norm(), bounds.derivative(5));
          EXPECT_LE(24 * (c[4] * p).norm(), bounds.derivative(4));
          EXPECT_LE(2 * (c[2] * p).norm(), bounds.derivative(2));
          EXPECT_LE(6 * (c[3] * p).norm(), bounds.derivative(3));
          EXPECT_LE((c[1] * p).norm(), bounds.derivative(1));
        }
      }
      EXPECT_LE(bounds.derivative(2), bounds.coarse_second_derivative() * (1 + 1e-9));
    }
  }
}

TEST(Motion, BoundsAreTightForOneAxis) {
  Robot robot;
  robot.links.resize(2);
  Joint joint;
  joint.type = JointType::Revolute;
  robot.joints.push_back(joint);
  robot.variables.push_back({"a", {}, {}});
  const std::vector<Vec3> points{{3, 4, 100}, {0, 1, -7}};
  const std::vector<double> from{0}, to{2};
  const LinkMotion motion(robot, 1, from, to);
  const MotionBounds bounds(motion, points);
  EXPECT_NEAR(bounds.derivative(1), 10, 1e-9);  // 5 away from the axis
  EXPECT_NEAR(bounds.derivative(2), 20, 1e-9);
  EXPECT_NEAR(bounds.derivative(4), 80, 1e-9);
  EXPECT_FALSE(LinkMotion(robot, 0, from, to).moves());
  EXPECT_FALSE(LinkMotion(robot, 1, to, to).moves());
}

/// Rounding is relative to what cancels, not to what is left of it.
TEST(Motion, FixedJointsThatGoFarAndComeBackAreInTheError) {
  constexpr double kFar = 1e9;
  Robot robot;
  robot.links.resize(4);
  robot.variables.push_back({"a", {}, {}});
  Joint turn, out, back;
  turn.type = JointType::Revolute;
  turn.axis = Vec3(1, 2, -1.5).normalized();
  out.parent = 1;
  out.origin = {robot::rotation_from_rpy(0.3, 0.2, 0.7), {kFar, 0.7 * kFar, -0.3 * kFar}};
  back.parent = 2;
  const Mat3 turned = out.origin.linear.transpose();
  back.origin = {turned, -(turned * out.origin.translation) + turned * Vec3::UnitX()};
  robot.joints = {turn, out, back};
  const std::vector<double> from{0.2}, to{1.4};
  const std::vector<Vec3> points{{0.1, 0, 0}};
  for (const std::uint32_t link : {3U, 2U}) {
    const LinkMotion motion(robot, link, from, to);
    const MotionBounds bounds(motion, points);
    EXPECT_GT(bounds.error(0), 1e-16 * kFar);
    for (const double s : {0.0, 0.4, 1.0}) {
      const Transform exact = reference_pose(robot, link, between(from, to, s));
      EXPECT_LE((motion.at(s) * points[0] - exact * points[0]).norm(), bounds.error(0));
    }
  }
}

TEST(Motion, TurnsThenSlides) {
  // A slide carried by a turn: |x''| is at most ρ q̇² + 2 q̇ ḋ, and nears it when far out.
  TestRobot r = prismatic_chain();
  const std::vector<double> from{0, 0, 0, 0, 0}, to{1, 0.5, 0, 0, 0};
  const LinkMotion motion(r.robot, 2, from, to);
  const MotionBounds bounds(motion, r.bodies[2].points);
  double most = 0;
  for (const Vec3& p : r.bodies[2].points)
    most = std::max(most, 2 * (motion.expand(1)[2] * p).norm());
  EXPECT_LE(most, bounds.derivative(2));
  EXPECT_GT(most, 0.4 * bounds.derivative(2));
}

}  // namespace
}  // namespace kaboum::test
