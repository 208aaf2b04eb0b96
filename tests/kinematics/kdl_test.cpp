// Chains of robots' files: solutions are judged by Orocos KDL's forward kinematics.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>

#include "arms.h"
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

/// A six-axis arm with a spherical wrist, as a file: joints that turn the other way, an offset
/// base, rotated frames, a tool.
const char* const kArmUrdf = R"(<robot name="arm">
<link name="world"/><link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/>
<link name="l4"/><link name="l5"/><link name="l6"/><link name="tool"/><link name="finger"/>
<joint name="mount" type="fixed"><parent link="world"/><child link="base"/><origin xyz="1 2 0.5" rpy="0.3 0 1"/></joint>
<joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><origin xyz="0 0 0.4"/><axis xyz="0 0 -1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.1 0.05 0.1"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="0 -0.1 0.6" rpy="0 0.7 0"/><axis xyz="0 -1 0"/><limit lower="-2.5" upper="2.5" effort="1" velocity="1"/></joint>
<joint name="j4" type="continuous"><parent link="l3"/><child link="l4"/><origin xyz="0.3 0 0.08"/><axis xyz="1 0 0"/></joint>
<joint name="j5" type="revolute"><parent link="l4"/><child link="l5"/><origin xyz="0.25 0 0"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="j6" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0.1 0 0"/><axis xyz="-1 0 0"/><limit lower="-6.5" upper="6.5" effort="1" velocity="1"/></joint>
<joint name="flange" type="fixed"><parent link="l6"/><child link="tool"/><origin xyz="0.1 0.02 0" rpy="0.1 0.2 0.3"/></joint>
<joint name="grip" type="prismatic"><parent link="tool"/><child link="finger"/><axis xyz="0 1 0"/><limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
</robot>)";

/// The chain between two links, by KDL.
KDL::Chain chain_of(const Robot& robot, std::uint32_t base, std::uint32_t tip) {
  std::vector<std::uint32_t> links;
  for (std::uint32_t l = tip; l != base; l = robot.joints[l - 1].parent) links.push_back(l);
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

KDL::Frame pose_by_kdl(const KDL::Chain& chain, std::span<const double> q) {
  KDL::ChainFkSolverPos_recursive fk(chain);
  KDL::JntArray joints(chain.getNrOfJoints());
  for (unsigned i = 0; i < chain.getNrOfJoints(); ++i) joints(i) = q[i];
  KDL::Frame frame;
  EXPECT_GE(fk.JntToCart(joints, frame), 0);
  return frame;
}

PoseError kdl_difference(const KDL::Frame& a, const Transform& b) {
  Transform t;
  for (int r = 0; r < 3; ++r) {
    t.translation[r] = a.p(r);
    for (int c = 0; c < 3; ++c) t.linear(r, c) = a.M(r, c);
  }
  return kinematics::difference(t, b);
}

/// Solves poses of random configurations; all solutions reach them by KDL, and one is the
/// configuration.
void check_chain(const Robot& robot, const std::string& base, const std::string& tip,
                 Family family) {
  const Arm arm = kinematics::arm_of(robot, base, tip);
  const auto form = recognise(arm);
  ASSERT_TRUE(form) << robot.name;
  EXPECT_EQ(form->family, family) << robot.name;
  const KDL::Chain chain = chain_of(robot, *robot.find_link(base), *robot.find_link(tip));
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const std::vector<double> q = random_joints(random, 6, std::numbers::pi);
    const KDL::Frame target = pose_by_kdl(chain, q);
    Transform pose = kinematics::forward(arm, q);
    EXPECT_LT(kdl_difference(target, pose).position, 1e-13);
    double nearest = 100;
    for (const Solution& s : solve(*form, pose)) {
      const PoseError error = kdl_difference(pose_by_kdl(chain, s.q), pose);
      EXPECT_LT(error.position + error.rotation, 1e-9) << robot.name;
      EXPECT_LE(error.position, s.position_error + 1e-14);
      nearest = std::min(nearest, turn_distance(s.q.data(), q));
    }
    EXPECT_LT(nearest, 1e-5) << robot.name << ' ' << trial;
  }
}

TEST(Chains, SolutionsReachThePoseByKdl) {
  const Robot robot = parse_urdf(kArmUrdf, "arm");
  check_chain(robot, "world", "tool", Family::SphericalWrist);
  check_chain(robot, "base", "l6", Family::SphericalWrist);
}

TEST(CorpusChains, RobotsOfMakers) {
  check_chain(parse_urdf(robot_file("ur5-description/urdf/ur5-robot.urdf"), "ur5"), "world",
              "tool0", Family::ParallelAxes);
  check_chain(parse_urdf(robot_file("kuka-kr120-support/urdf/kr120r2500pro.urdf"), "kr120"),
              "base_link", "link_6", Family::SphericalWrist);
  const Robot puma = parse_rl(robot_file("puma560-vrml/unimation-puma560-rlkin.xml"), "puma");
  check_chain(puma, puma.links.front().name, puma.links.back().name, Family::SphericalWrist);
}

TEST(Chains, AgreeWithTheRobotsKinematics) {
  const Robot robot = prismatic_chain().robot;
  const Arm arm = kinematics::arm_of(robot, "base", "link 5");
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<double> q = random_joints(random, 5, 2);
    Transform pose;
    const auto j = kinematics::jacobian(arm, q, &pose);
    EXPECT_LT(kinematics::difference(robot::forward(robot, q)[5], pose).position, 1e-14);
    EXPECT_LT(kinematics::difference(kinematics::forward(arm, q), pose).rotation, 1e-14);
    EXPECT_LT((j - robot::jacobian(robot, q, 5, Vec3::Zero())).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(Chains, OffsetsAndRatesOfJointsAreKept) {
  Robot robot = prismatic_chain().robot;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    robot.joints[i].multiplier = i % 2 == 0 ? -1.5 : 2;
    robot.joints[i].offset = 0.3 * static_cast<double>(i) - 0.5;
  }
  const Arm arm = kinematics::arm_of(robot, "link 1", "link 5");
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<double> q = random_joints(random, 5, 2);
    const auto poses = robot::forward(robot, q);
    Transform pose;
    const auto j = kinematics::jacobian(arm, std::span(q).subspan(1), &pose);
    EXPECT_LT(kinematics::difference(poses[1] * pose, poses[5]).position, 1e-14);
    EXPECT_LT(kinematics::difference(poses[1] * pose, poses[5]).rotation, 1e-14);
    const auto expected = robot::jacobian(robot, q, 5, Vec3::Zero());
    EXPECT_LT((poses[1].linear * j.topRows(3) - expected.topRows(3).rightCols(4)).norm(), 1e-13);
  }
}

std::string message_of(const Robot& robot, const char* base, const char* tip) {
  try {
    kinematics::arm_of(robot, base, tip);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Chains, SaysWhatIsWrongWithThem) {
  Robot robot = parse_urdf(kArmUrdf, "arm");
  EXPECT_NE(message_of(robot, "base", "toll").find("did you mean 'tool'"), std::string::npos);
  EXPECT_NE(message_of(robot, "tool", "base").find("is not between"), std::string::npos);
  EXPECT_NE(message_of(robot, "l6", "tool").find("nothing moves"), std::string::npos);
  robot.joints[4].variable = robot.joints[3].variable;
  EXPECT_NE(message_of(robot, "base", "tool").find("moves another joint"), std::string::npos);
}

}  // namespace
}  // namespace kaboum::test
