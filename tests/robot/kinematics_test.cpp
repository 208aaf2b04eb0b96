#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>

#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>

#include "robots.h"

namespace kaboum::test {
namespace {

KDL::Frame frame_of(const Transform& t) {
  KDL::Frame f;
  for (int r = 0; r < 3; ++r) {
    f.p(r) = t.translation[r];
    for (int c = 0; c < 3; ++c) f.M(r, c) = t.linear(r, c);
  }
  return f;
}

/// The chain of the last link, by Orocos KDL.
KDL::Chain chain_of(const Robot& robot, std::uint32_t link) {
  std::vector<std::uint32_t> links;
  for (std::uint32_t l = link; l > 0; l = robot.joints[l - 1].parent) links.push_back(l);
  KDL::Chain chain;
  for (auto it = links.rbegin(); it != links.rend(); ++it) {
    const Joint& j = robot.joints[*it - 1];
    const KDL::Frame origin = frame_of(j.origin);
    const KDL::Vector axis = origin.M * KDL::Vector(j.axis.x(), j.axis.y(), j.axis.z());
    KDL::Joint joint(KDL::Joint::None);
    if (j.type == JointType::Revolute)
      joint = KDL::Joint(j.name, origin.p, axis, KDL::Joint::RotAxis);
    if (j.type == JointType::Prismatic)
      joint = KDL::Joint(j.name, origin.p, axis, KDL::Joint::TransAxis);
    chain.addSegment(KDL::Segment(joint, origin));
  }
  return chain;
}

TEST(Kinematics, PosesAndJacobiansAgreeWithKdl) {
  std::mt19937_64 random(1);
  for (const TestRobot& r : test_robots()) {
    const auto link = static_cast<std::uint32_t>(r.bodies.back().link);
    KDL::Chain chain = chain_of(r.robot, link);
    KDL::ChainFkSolverPos_recursive fk(chain);
    for (int trial = 0; trial < 200; ++trial) {
      const std::vector<double> q = random_path(r.robot, random, 1, 3, false).front();
      KDL::JntArray joints(chain.getNrOfJoints());
      ASSERT_EQ(q.size(), chain.getNrOfJoints());
      for (unsigned i = 0; i < q.size(); ++i) joints(i) = q[i];
      KDL::Frame frame;
      ASSERT_GE(fk.JntToCart(joints, frame), 0);
      const Transform pose = forward(r.robot, q)[link];
      for (int row = 0; row < 3; ++row) {
        EXPECT_NEAR(pose.translation[row], frame.p(row), 1e-13) << r.name;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(pose.linear(row, c), frame.M(row, c), 1e-13);
      }
      KDL::ChainJntToJacSolver solver(chain);
      KDL::Jacobian expected(chain.getNrOfJoints());
      ASSERT_GE(solver.JntToJac(joints, expected), 0);
      const auto got = jacobian(r.robot, q, link, Vec3::Zero());
      EXPECT_LT((got - expected.data).cwiseAbs().maxCoeff(), 1e-13) << r.name;
    }
  }
}

TEST(Kinematics, JacobianIsTheDerivativeOfThePose) {
  const TestRobot r = prismatic_chain();
  const std::vector<double> q{0.3, 0.2, -1, 0.4, 2};
  const Vec3 p(0.1, -0.2, 0.3);
  const auto j = jacobian(r.robot, q, 5, p);
  for (std::size_t i = 0; i < q.size(); ++i) {
    std::vector<double> a = q, b = q;
    a[i] -= 1e-6;
    b[i] += 1e-6;
    const Vec3 slope = (forward(r.robot, b)[5] * p - forward(r.robot, a)[5] * p) / 2e-6;
    EXPECT_LT((slope - j.col(static_cast<Eigen::Index>(i)).head<3>()).norm(), 1e-9);
  }
}

TEST(Kinematics, DenavitHartenbergInBothConventions) {
  // Both tables of one arm, whose product is the same but for the last link's frame.
  const double h = std::numbers::pi / 2;
  const std::array<double, 6> d{0.35, 0, 0.05, 0.425, 0, 0.085}, a{0.085, 0.38, 0.1, 0, 0, 0},
      alpha{-h, 0, -h, h, -h, 0}, theta{0.1, -0.7, 1.3, 2, -0.4, 0.9};
  Transform distal, proximal;
  for (std::size_t i = 0; i < 6; ++i) {
    distal = distal * dh_distal({theta[i], d[i], a[i], alpha[i]});
    proximal =
        proximal * dh_proximal({theta[i], d[i], i > 0 ? a[i - 1] : 0, i > 0 ? alpha[i - 1] : 0});
  }
  EXPECT_LT((distal.linear - proximal.linear).norm(), 1e-14);
  EXPECT_LT((distal.translation - proximal.translation).norm(), 1e-14);
  // One joint by hand: x turned by 90° about z, moved, then tilted about the new x.
  const Transform one = dh_distal({h, 2, 3, h});
  EXPECT_LT((one.translation - Vec3(0, 3, 2)).norm(), 1e-15);
  EXPECT_LT((one.linear * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((one.linear * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-15);
}

TEST(Kinematics, LimitsAndWrongNumbersOfValues) {
  TestRobot r = six_axis_arm();
  r.robot.variables[2].lower = -1;
  r.robot.variables[4].upper = 1;
  EXPECT_EQ(find_out_of_limits(r.robot, std::vector<double>(6, 0)), std::nullopt);
  EXPECT_EQ(find_out_of_limits(r.robot, std::vector<double>(6, -1.5)), 2U);
  EXPECT_EQ(find_out_of_limits(r.robot, std::vector<double>(6, 1.5)), 4U);
  EXPECT_THROW(forward(r.robot, std::vector<double>(5, 0)), Error);
  EXPECT_THROW(jacobian(r.robot, std::vector<double>(6, 0), 7, Vec3::Zero()), Error);
}

}  // namespace
}  // namespace kaboum::test
