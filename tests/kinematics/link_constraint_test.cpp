// Features fixed to links between base and tool: their frames against the robot's kinematics,
// derivatives against differences, samples in other words.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/kinematics/sample.h>
#include <kaboum/robot/kinematics.h>

#include <cmath>

#include "arms.h"

namespace kaboum::test {
namespace {

using Kind = FrameId::Kind;
const FrameId kBase;

/// Three joints, one that moves along and one with an offset, a bracket fixed to the second link,
/// a finger that follows the last joint's variable, a branch of its own.
robot::Robot crane() {
  return robot::parse_urdf(R"(<robot name="crane"><link name="foot"/><link name="post"/>
    <link name="boom"/><link name="bracket"/><link name="hook"/><link name="end"/><link name="side"/>
    <link name="twin"/>
    <joint name="turn" type="continuous"><parent link="foot"/><child link="post"/>
      <origin xyz="0.1 0 0.5" rpy="0.1 0.2 0.3"/><axis xyz="0 0.6 0.8"/></joint>
    <joint name="out" type="prismatic"><parent link="post"/><child link="boom"/>
      <origin xyz="0 0.3 1" rpy="0 0.4 0"/><axis xyz="1 0 0"/>
      <limit lower="0" upper="2" effort="1" velocity="1"/></joint>
    <joint name="plate" type="fixed"><parent link="boom"/><child link="bracket"/>
      <origin xyz="0.2 0 -0.1" rpy="1 0 0.5"/></joint>
    <joint name="swing" type="revolute"><parent link="bracket"/><child link="hook"/>
      <origin xyz="0.5 0 0"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    <joint name="tip" type="fixed"><parent link="hook"/><child link="end"/><origin xyz="0 0 -0.4"/></joint>
    <joint name="aside" type="continuous"><parent link="post"/><child link="side"/><axis xyz="0 0 1"/></joint>
    <joint name="follows" type="prismatic"><parent link="post"/><child link="twin"/>
      <origin xyz="0 -0.3 1"/><axis xyz="1 0 0"/><limit lower="0" upper="2" effort="1" velocity="1"/>
      <mimic joint="out"/></joint></robot>)",
                           "crane.urdf");
}

TEST(ArmFrames, MoveAsTheRobotsLinks) {
  const robot::Robot robot = crane();
  const Arm arm = kinematics::arm_of(robot, "foot", "end");
  ASSERT_EQ(arm.axes.size(), 3U);
  std::mt19937_64 random(1);
  const std::vector<std::pair<std::string, std::size_t>> links{
      {"foot", 0}, {"post", 1}, {"boom", 2}, {"bracket", 2}, {"hook", 3}, {"end", 3}};
  for (int i = 0; i < 20; ++i) {
    const std::vector<double> q = random_joints(random, 3, 2);
    std::vector<double> all(robot.variables.size(), 0);
    for (std::size_t k = 0; k < 3; ++k) all[arm.variables[k]] = q[k];
    const auto poses = robot::forward(robot, all);
    for (const auto& [name, axes] : links) {
      const ArmFrame frame = frame_of(robot, arm, "foot", name);
      EXPECT_EQ(frame.axes, axes) << name;
      const Transform pose =
          kinematics::forward(arm_to(arm, frame), std::span(q).first(frame.axes));
      const PoseError error = difference(pose, poses[*robot.find_link(name)]);
      EXPECT_LT(error.position + error.rotation, 1e-12) << name;
    }
  }
  // What else moves them is no joint of the arm, even where it has the same variable.
  for (const char* name : {"side", "twin"}) try {
      (void)frame_of(robot, arm, "foot", name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find("is not the arm's"), std::string::npos);
    }
  EXPECT_THROW((void)frame_of(robot, arm, "foot", "nobody"), Error);
}

/// Features on all links of the crane, related to the world, to each other and to an object.
ConstraintProblem on_all_links() {
  const robot::Robot robot = crane();
  ConstraintProblem problem;
  const Arm arm = kinematics::arm_of(robot, "foot", "end");
  problem.robots = {
      {arm,
       {robot::rotation_from_rpy(0.3, -0.2, 1), {0.5, 1, -0.25}},
       {frame_of(robot, arm, "foot", "foot"), frame_of(robot, arm, "foot", "post"),
        frame_of(robot, arm, "foot", "bracket"), frame_of(robot, arm, "foot", "hook")}}};
  problem.objects = {{}};
  const FrameId object{Kind::Object, 0}, tool{Kind::Tool, 0};
  const auto link = [](std::size_t k) { return FrameId{Kind::Link, 0, k}; };
  problem.constraints = {
      {Relation::Coincident, {link(0), Point{{0.1, 0.2, 0.3}}}, {object, Plane{}}},
      {Relation::Distance, {link(1), Point{{0.1, 0, 0.3}}}, {kBase, Line{}}, 0.4},
      {Relation::Parallel, {link(2), Line{{0.3, 0, 0}, {0.6, 0, 0.8}}}, {object, Line{}}},
      {Relation::Angle, {link(3), Plane{}}, {link(1), Plane{{1, 0, 0}, {0, 0.6, 0.8}}}, 0.7},
      {Relation::Coincident, {link(2), Point{{0, 1, 0}}}, {tool, Plane{{0, 0, 1}, {0, 1, 0}}}}};
  return problem;
}

TEST(LinkFeatures, DerivativesAreThoseOfDifferences) {
  const ConstraintProblem problem = on_all_links();
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 10; ++trial) {
    const Placement at{{random_joints(random, 3, 1.5)}, {random_pose(random, 1)}};
    const Costs exact = evaluate(problem, at, 1);
    ASSERT_EQ(exact.derivative.cols(), 9);
    for (Eigen::Index column = 0; column < 9; ++column) {
      const auto value = [&](double h) {
        Placement x = at;
        const Vec3 unit = Vec3::Unit(static_cast<int>(column % 3));
        if (column < 3)
          x.joints[0][static_cast<std::size_t>(column)] += h;
        else if (column < 6)
          x.objects[0].translation += h * unit;
        else
          x.objects[0].linear = robot::rotation_about(unit, h) * x.objects[0].linear;
        return evaluate(problem, x, 1).value;
      };
      const Eigen::VectorXd slope = (value(1e-5) - value(-1e-5)) / 2e-5;
      EXPECT_LT((slope - exact.derivative.col(column)).cwiseAbs().maxCoeff(), 1e-8) << column;
    }
  }
}

/// The elbow of a six-axis arm on a horizontal plane, the tool pointing down.
ConstraintProblem elbow_at(double height, std::size_t axes) {
  const DhArm dh = rv_6sl(true);
  ConstraintProblem problem;
  PlacedArm robot{test::arm_of(dh), {}, {}};
  for (Axis& axis : robot.arm.axes) {
    axis.lower = -2.4;
    axis.upper = 2.6;
  }
  // The frame after so many rows.
  DhArm part = dh;
  part.rows.resize(axes);
  part.tool = {};
  robot.links = {{axes, reference_pose(part, std::vector<double>(axes, 0))}};
  problem.robots = {robot};
  problem.constraints = {{Relation::Coincident,
                          {{Kind::Link, 0, 0}, Point{}},
                          {kBase, Plane{{0, 0, height}, {0, 0, 1}}}},
                         {Relation::Angle, {{Kind::Tool, 0}, Line{}}, {kBase, Line{}}, 2.5}};
  return problem;
}

TEST(LinkFeatures, SamplesPutTheElbowWhereItShouldBe) {
  const ConstraintProblem problem = elbow_at(0.5, 2);
  ConstraintSampler sampler(problem);
  const DhArm dh = rv_6sl(true);
  DhArm part = dh;
  part.rows.resize(2);
  part.tool = {};
  for (int i = 0; i < 40; ++i) {
    const auto s = sampler.next();
    ASSERT_TRUE(s) << i;
    std::vector<double> q = s->at.joints[0];
    EXPECT_TRUE(within_limits(problem.robots[0].arm, q));
    EXPECT_NEAR(reference_pose(dh, q).linear(2, 2), std::cos(2.5), 1e-7);
    q.resize(2);
    EXPECT_NEAR(reference_pose(part, q).translation.z(), 0.5, 1e-8);
  }
  // The tool's pose does not say where the elbow is.
  EXPECT_EQ(sampler.tally().solved, 0U);
}

// What moves with the tool is as good as the tool's, and the base's as the world's.
TEST(LinkFeatures, OfTheLastLinkAreSolvedInClosedForm) {
  ConstraintProblem problem = elbow_at(0.4, 6);
  ConstraintSampler sampler(problem);
  for (int i = 0; i < 20; ++i) {
    const auto s = sampler.next();
    ASSERT_TRUE(s) << i;
    DhArm dh = rv_6sl(true);
    dh.tool = {};
    EXPECT_NEAR(reference_pose(dh, s->at.joints[0]).translation.z(), 0.4, 1e-8);
  }
  EXPECT_GT(sampler.tally().solved, 0U);
  problem.robots[0].links[0] = {0, {Eigen::Matrix3d::Identity(), {0, 0, 0.4}}};
  ConstraintSampler resting(problem);  // a point that rests on a plane: nothing is asked of it
  EXPECT_TRUE(resting.next());
  problem.robots[0].links[0].pose.translation.z() = 0.3;
  ConstraintSampler never(problem, {.draws = 20});
  EXPECT_FALSE(never.next());
}

TEST(LinkFeatures, WhatTheProblemDoesNotHaveIsRefused) {
  ConstraintProblem problem = elbow_at(0.5, 2);
  const auto message = [&] {
    try {
      const ConstraintSampler sampler(problem);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  problem.constraints[0].first.frame.link = 1;
  EXPECT_NE(message().find("there is no link of that robot number 1"), std::string::npos);
  EXPECT_NE(message().find("(constraint 0"), std::string::npos);
  problem.constraints[0].first.frame = {Kind::Link, 1, 0};
  EXPECT_NE(message().find("there is no robot number 1"), std::string::npos);
  problem = elbow_at(0.5, 2);
  problem.robots[0].links[0].axes = 7;
  EXPECT_NE(message().find("more axes than its arm"), std::string::npos);
}

}  // namespace
}  // namespace kaboum::test
