// Plans carried out among exact meshes: what is wrong with a plan is counted.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/execution/simulation.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/manipulation/kept_constraints.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/plan/load.h>

namespace kaboum::execution {
namespace {

geom::Mesh box(const geom::Vec3& size) {
  geom::Mesh out;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5})
        out.vertices.emplace_back(geom::Vec3(x, y, z).cwiseProduct(size));
  out.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                   {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return out;
}

/// A slider along x with a hand; a block at its grasp when it is at 1, a wall behind 2.
struct Case {
  world::World world;
  judge::Cell cell;

  Case() {
    world::RobotModel robot;
    robot.name = "arm";
    robot.kinematics = robot::parse_urdf(
        R"(<robot name="arm"><link name="rail"/><link name="hand"><collision><geometry>
        <box size="0.1 0.1 0.1"/></geometry></collision></link>
        <joint name="x" type="prismatic"><parent link="rail"/><child link="hand"/><axis xyz="1 0 0"/>
        <limit lower="-1" upper="3" effort="1" velocity="0.5"/></joint></robot>)",
        "test");
    robot.home = {0};
    robot.tools = {{"tip", 1, {Eigen::Matrix3d::Identity(), {0.06, 0, 0}}}};
    world.robots.push_back(robot);
    const auto object = [](const char* name, double x) {
      return world::Object{name,
                           {Eigen::Matrix3d::Identity(), {x, 0, 0}},
                           {{}, collide::Direction::Outer, 0},
                           {},
                           {},
                           {}};
    };
    world.objects = {object("block", 1.12), object("wall", 2.6)};
    world.objects[0].grasps = {{"back", {Eigen::Matrix3d::Identity(), {0.06, 0, 0}}}};
    world.attachments.resize(2);
    cell.add_robot("arm", world.robots[0].kinematics, {});
    cell.add_link(0, 1, box({0.1, 0.1, 0.1}));
    cell.add_object("block", box({0.1, 0.1, 0.1}));
    cell.add_object("wall", box({0.1, 1, 1}));
  }
};

const char* const kDomain = R"(
types: object, robot, conf handle, pose handle
constants: robot arm; object block; conf home; pose start, away
predicates: isHeavy(object), isHeld(object), isDone
functions: conf(robot) : conf; pose(object) : pose
externals: reach(robot, object) : conf; grasp(robot, object, conf) : pose; carry(robot, object) : pose
action pick(?o : object)
  preconds: let ?q = extern(reach(arm, ?o)) & let ?p = extern(grasp(arm, ?o, ?q))
  effects: add(Kf, isHeld(?o)), add(Kf, conf(arm) = ?q), add(Kf, pose(?o) = ?p)
action weigh(?o : object)
  preconds: K(isHeld(?o))
  effects: add(Kw, isHeavy(?o))
action drop(?o : object)
  preconds: K(isHeld(?o)) & K(!isHeavy(?o))
  effects: add(Kf, isDone), add(Kf, pose(?o) = away)
action keep(?o : object)
  preconds: K(isHeld(?o)) & K(isHeavy(?o))
  effects: add(Kf, isDone)
init: K(conf(arm) = home), K(pose(block) = start)
goal: K(isDone)
)";

/// A host that says what it is told to.
plan::ExternalBindings host() {
  const auto nothing = [](const plan::Question&) { return plan::Answer::not_found(""); };
  return {{"reach", nothing}, {"grasp", nothing}, {"carry", nothing}};
}

plan::Plan plan_to(const plan::Model& model, double stop, const std::string& grasp) {
  const std::string q = manipulation::word_of(std::vector<double>{stop});
  const std::string number = q.substr(2);
  return read_plan(model,
                   R"({"format": "kaboum-plan", "version": 1, "root": 0, "nodes": [
    {"action": "pick", "arguments": ["block"], "calls": [
      {"external": "reach", "arguments": ["arm", "block"], "value": ")" +
                       q + R"(", "payload": "[{\"robot\":\"arm\",\"path\":[[0.0],[)" + number +
                       R"(]]}]"},
      {"external": "grasp", "arguments": ["arm", "block", ")" +
                       q + R"("], "value": ")" + grasp +
                       R"("}], "next": 1},
    {"action": "weigh", "arguments": ["block"], "branch": {"predicate": "isHeavy", "arguments": ["block"],
      "cases": [{"value": true, "next": 2}, {"value": false, "next": 3}]}},
    {"action": "keep", "arguments": ["block"], "next": "goal"},
    {"action": "drop", "arguments": ["block"], "next": "goal"}]})",
                   "test");
}

struct Outcome {
  SimulationReport report;
  plan::RunSummary summary;
};

Outcome carry_out(Case& c, double stop, const std::string& grasp,
                  const plan::RunOptions& options = {},
                  const std::vector<ExecutedMotion>& executed = {}) {
  const plan::Model model = plan::load({"test", kDomain}, nullptr, host());
  const plan::Plan plan = plan_to(model, stop, grasp);
  Simulation simulation(c.world, c.cell, model, plan, {});
  Outcome out;
  out.summary = run(model, plan, options,
                    [&](const plan::RunStep& step) { simulation.carry_out(step, executed); });
  out.report = simulation.report();
  return out;
}

TEST(Simulation, CarriesOutEveryBranch) {
  Case c;
  const Outcome all = carry_out(c, 1, "on arm/hand 0.12 0 0 0 0 0 1");
  EXPECT_TRUE(all.report.good()) << all.report.problems.front();
  EXPECT_EQ(all.summary.branches, 2U);
  EXPECT_EQ(all.report.motions, 1U);
  EXPECT_EQ(all.report.steps, 4U);
  // 15/8 of 1 m at 0.5 m/s, at 1 kHz, and one for rounding.
  EXPECT_EQ(all.report.samples, 3752U);
  EXPECT_NEAR(all.report.most_velocity, 1, 1e-3);
  EXPECT_LE(all.report.most_velocity, 1 + 1e-9);
  plan::RunOptions one;
  one.outcomes = plan::RunOptions::Outcomes::Given;
  one.given = {{"isHeavy(block)", "true"}};
  EXPECT_EQ(carry_out(c, 1, "on arm/hand 0.12 0 0 0 0 0 1", one).report.steps, 3U);
  one.given = {{"isHeavy(nothing)", "true"}};
  EXPECT_THROW(carry_out(c, 1, "on arm/hand 0.12 0 0 0 0 0 1", one), Error);
}

TEST(Simulation, CountsWhatIsWrong) {
  Case c;
  // Through the block: samples in contact, and the hand is at no grasp then.
  const Outcome through = carry_out(c, 1.05, "on arm/hand 0.07 0 0 0 0 0 1");
  EXPECT_GT(through.report.collisions, 0U);
  EXPECT_GT(through.report.jumps, 0U);
  // The block is said to be elsewhere in the hand than it is.
  EXPECT_GT(carry_out(c, 1, "on arm/hand 0.13 0 0 0 0 0 1").report.jumps, 0U);
  // Too far away for a grasp.
  EXPECT_GT(carry_out(c, 0.9, "on arm/hand 0.22 0 0 0 0 0 1").report.jumps, 0U);
  // Beyond the limit of the joint.
  c.world.objects[0].pose.translation = {-1.38, 0, 0};
  EXPECT_GT(carry_out(c, -1.5, "on arm/hand 0.12 0 0 0 0 0 1").report.limit_violations, 0U);
}

TEST(Simulation, LooksAtWhatWasExecuted) {
  Case c;
  const std::string held = "on arm/hand 0.12 0 0 0 0 0 1";
  // 3.75 s to 1; at 50 Hz 188 steps.
  ExecutedMotion executed{50, {{0, {0}}, {1.88, {0.5}}, {3.76, {1}}, {9, {1}}}};
  Outcome as_told = carry_out(c, 1, held, {}, {executed});
  EXPECT_TRUE(as_told.report.good()) << as_told.report.problems.front();
  EXPECT_EQ(as_told.report.executed.motions, 1U);
  EXPECT_EQ(as_told.report.executed.samples, 4U);
  EXPECT_LT(as_told.report.executed.most_strayed, 1e-9);
  EXPECT_LT(as_told.report.executed.margin, 1e-9);
  // A slider: points are as far as the joint.
  executed.samples[1].q = {0.53};
  as_told = carry_out(c, 1, held, {}, {executed});
  EXPECT_TRUE(as_told.report.good());
  EXPECT_NEAR(as_told.report.executed.most_strayed, 0.03, 1e-9);
  EXPECT_NEAR(as_told.report.executed.margin, 0.03, 1e-9);
  // Into the block before it has stopped, though what it was told is free.
  executed.samples[2].q = {1.03};
  const Outcome into = carry_out(c, 1, held, {}, {executed});
  EXPECT_EQ(into.report.collisions, 0U);
  EXPECT_EQ(into.report.executed.collisions, 1U);
  EXPECT_FALSE(into.report.good());
  EXPECT_NE(into.report.problems.front().find("as it was executed"), std::string::npos);
}

TEST(Simulation, AToolIsAtAnyMemberOfAFamily) {
  // The block 1 cm aside, and in the hand likewise: at no grasp but that of a slide.
  Case c;
  c.world.objects[0].pose.translation.y() = 0.01;
  const std::string held = "on arm/hand 0.12 0.01 0 0 0 0 1";
  EXPECT_GT(carry_out(c, 1, held).report.jumps, 0U);
  world::Grasp& grasp = c.world.objects[0].grasps[0];
  grasp.slides = {{geom::Vec3::UnitY(), -0.02, 0.003}};
  const Outcome within = carry_out(c, 1, held);
  EXPECT_TRUE(within.report.good()) << within.report.problems.front();
  // The tool would have to slide by -0.01.
  grasp.slides = {{geom::Vec3::UnitY(), -0.0099, 0.02}};
  EXPECT_GT(carry_out(c, 1, held).report.jumps, 0U);
  grasp.slides = {{geom::Vec3::UnitZ(), -0.02, 0.02}};
  EXPECT_GT(carry_out(c, 1, held).report.jumps, 0U);
}

/// The block is picked; then the hand moves on by these parts of a motion, and the block is away.
SimulationReport taken_away(const std::string& parts) {
  Case c;
  std::string domain = kDomain;
  domain.insert(domain.find("init:"),
                "action remove(?o : object)\n  preconds: let ?q = extern(reach(arm, ?o))\n"
                "  effects: add(Kf, isDone), add(Kf, conf(arm) = ?q), add(Kf, pose(?o) = away)\n");
  const plan::Model model = plan::load({"test", domain}, nullptr, host());
  std::string json = R"({"format": "kaboum-plan", "version": 1, "root": 0, "nodes": [
    {"action": "pick", "arguments": ["block"], "calls": [
      {"external": "reach", "arguments": ["arm", "block"], "value": "q 1",
       "payload": "[{\"robot\":\"arm\",\"path\":[[0.0],[1.0]]}]"},
      {"external": "grasp", "arguments": ["arm", "block", "q 1"],
       "value": "on arm/hand 0.12 0 0 0 0 0 1"}], "next": 1},
    {"action": "remove", "arguments": ["block"], "calls": [
      {"external": "reach", "arguments": ["arm", "block"], "value": "q 0.5", "payload": "PARTS"}],
     "next": "goal"}]})";
  json.replace(json.find("PARTS"), 5, parts);
  const plan::Plan plan = read_plan(model, json, "test");
  Simulation simulation(c.world, c.cell, model, plan, {});
  run(model, plan, {}, [&](const plan::RunStep& step) { simulation.carry_out(step); });
  return simulation.report();
}

TEST(Simulation, WhatIsLeftBehindIsNotTakenAway) {
  const std::string empty = R"({\"robot\":\"arm\",\"path\":[[1.0],[0.5]]})";
  const std::string holding =
      R"({\"robot\":\"arm\",\"path\":[[1.0],[0.5]],\"holds\":{\"block\":\"hand\"}})";
  const SimulationReport left = taken_away("[" + empty + "]");
  EXPECT_EQ(left.jumps, 1U);
  ASSERT_EQ(left.problems.size(), 1U);
  EXPECT_NE(left.problems[0].find("block stays where it was"), std::string::npos)
      << left.problems[0];
  EXPECT_TRUE(taken_away("[" + holding + "]").good());
  // Carried, put down, and left there.
  EXPECT_TRUE(
      taken_away("[" + holding + R"(,{\"robot\":\"arm\",\"path\":[[0.5],[0.4],[0.5]]}])").good());
}

// What a motion keeps is known from the function that made it.
TEST(KeptConstraints, AreThoseOfTheFunction) {
  const Case c;
  world::WorldState state = initial_state(c.world);
  const robot::Path path{{0.0}, {0.5}};
  const auto kept = [&](const char* function, const std::vector<std::string>& arguments) {
    return manipulation::kept_constraints(c.world, state, 0, path, function, arguments);
  };
  ASSERT_TRUE(kept("move", {"arm", "home"}));
  EXPECT_TRUE(kept("move", {"arm", "home"})->empty());
  EXPECT_FALSE(kept("follow", {"arm", "volume"}));
  EXPECT_FALSE(kept("ofAUser", {"arm"}));
  const std::vector<std::string> put{"arm", "block", "wall", "home"};
  EXPECT_TRUE(kept("putUpright", put)->empty());  // it holds nothing any more
  state.attachments[0] = world::Attachment{0, 1, {}, {}};
  EXPECT_TRUE(kept("put", put)->empty());
  ASSERT_EQ(kept("putUpright", put)->size(), 1U);
  EXPECT_EQ(kept("putUpright", put)->front().link, 1U);
  EXPECT_EQ(kept("putUpright", put)->front().within_angle, manipulation::ExternalOptions().upright);
  EXPECT_THROW(kept("putUpright", {"arm", "nothing", "wall", "home"}), Error);
  // What was never pushed: it has no point to stand on.
  EXPECT_THROW(kept("push", put), Error);
}

}  // namespace
}  // namespace kaboum::execution
