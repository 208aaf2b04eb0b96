// Plans as files: which way a robot takes, by what it has sensed; where it is planned again.

#include <gtest/gtest.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/plan/load.h>
#include <node_events.h>
#include <timeline.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

namespace kaboum::execution {
namespace {

using nlohmann::json;

const char* const kTwoFacts = R"(
types: object, robot, conf handle, pose handle
constants: robot arm; object block; conf home; pose start
predicates: isHeavy(object), isRed(object), isDone
functions: conf(robot) : conf; pose(object) : pose
action look(?o : object)
  preconds: true
  effects: add(Kw, isHeavy(?o)), add(Kw, isRed(?o))
action keep(?o : object)
  preconds: K(isRed(?o))
  effects: add(Kf, isDone)
action drop(?o : object)
  preconds: true
  effects: add(Kf, isDone)
init: K(conf(arm) = home), K(pose(block) = start)
goal: K(isDone)
)";

world::World arm_and_block() {
  world::World out;
  world::RobotModel robot;
  robot.name = "arm";
  robot.kinematics = robot::parse_urdf(
      R"(<robot name="arm"><link name="rail"/><link name="hand"/>
      <joint name="x" type="prismatic"><parent link="rail"/><child link="hand"/><axis xyz="1 0 0"/>
      <limit lower="-1" upper="3" effort="1" velocity="0.5"/></joint></robot>)",
      "test");
  robot.home = {0};
  out.robots.push_back(robot);
  out.objects.push_back({"block", {}, {{}, collide::Direction::Outer, 0}, {}, {}, {}});
  out.attachments.resize(1);
  return out;
}

/// What is written of a plan: looked at, kept if it is red and heavy, else dropped.
/// @param light  what follows if it is not heavy
json written(const std::string& light, const std::vector<plan::Replan>& replans) {
  const world::World scene = arm_and_block();
  const plan::Model model = plan::load({"test", kTwoFacts}, nullptr, {});
  const plan::Plan plan =
      plan::read_plan(model,
                      R"({"format": "kaboum-plan", "version": 1, "root": 0, "nodes": [
      {"action": "look", "arguments": ["block"], "branch": {"predicate": "isHeavy", "arguments": ["block"],
        "cases": [{"value": true, "next": 1})" +
                          light + R"(]}},
      {"branch": {"predicate": "isRed", "arguments": ["block"],
        "cases": [{"value": true, "next": 2}, {"value": false, "next": 3}]}},
      {"action": "keep", "arguments": ["block"], "next": "goal"},
      {"action": "drop", "arguments": ["block"], "next": "goal"}]})",
                      "test");
  // Tests may run at once.
  const auto folder = std::filesystem::path(::testing::TempDir()) /
                      (std::string("kaboum-timeline-") +
                       ::testing::UnitTest::GetInstance()->current_test_info()->name());
  Timeline timeline(scene, folder, MotionFormat::Csv, 100);
  timeline.begin(model, plan,
                 std::make_shared<NodeMotions>(scene, model, plan, SimulationOptions()));
  plan::RunOptions options;
  options.unplanned = [](const plan::Unplanned&) {};
  plan::run(model, plan, options, [&](const plan::RunStep& step) { timeline.add(step); });
  timeline.write(replans);
  std::ifstream file(folder / "plan.json");
  json out = json::parse(file);
  file.close();
  std::filesystem::remove_all(folder);
  return out;
}

std::vector<json> ways_of(const json& plan, int node) {
  std::vector<json> out;
  for (const json& step : plan["steps"])
    if (step["node"] == node)
      for (const json& way : step["ways"]) out.push_back(way);
  return out;
}

TEST(Timeline, WaysOfAStepDifferInWhatIsSensedOrDecides) {
  const json plan = written(R"(, {"value": false, "next": 3})", {});
  EXPECT_EQ(ways_of(plan, 0).size(), 4U) << "two facts are sensed";
  for (const json& step : plan["steps"]) {
    std::set<std::string> told;
    for (const json& way : step["ways"])
      EXPECT_TRUE(told.insert(way["if"].dump() + way["sensed"].dump()).second) << step;
  }
  for (const json& way : ways_of(plan, 0)) {
    EXPECT_EQ(way["if"]["fact"], "isHeavy(block)");
    EXPECT_EQ(way["if"]["value"], way["sensed"]["isHeavy(block)"]);
    EXPECT_FALSE(way.contains("plan"));
  }
  const std::vector<json> red = ways_of(plan, 1);
  ASSERT_EQ(red.size(), 2U) << "what was sensed before decides";
  EXPECT_NE(red[0]["next"], red[1]["next"]);
  for (const json& way : red) EXPECT_EQ(way["if"]["fact"], "isRed(block)");
  for (const json& way : ways_of(plan, 2)) {
    EXPECT_TRUE(way["if"].is_null());
    EXPECT_TRUE(way["next"].is_null());
  }
}

/// What the state after a node says is held is taken when its motions are over, and let go
/// likewise.
TEST(Timeline, WhatIsHeldAfterwardsIsTakenAtTheEnd) {
  judge::CellState after;
  after.objects.resize(3);
  after.objects[0].hold = judge::Hold{1, 4, {}, {}, true};
  after.objects[2].hold = judge::Hold{0, 2, {}, {}, true};
  Held held{{1, {0, 2}}, {2, {1, 4}}};
  const std::vector<NodeEvent> events = settling_events(after, held);
  using Kind = NodeEvent::Kind;
  const auto is = [&](std::size_t k, Kind kind, std::size_t object, const Holder& by) {
    EXPECT_EQ(events[k].kind, kind) << k;
    EXPECT_EQ(events[k].object, object) << k;
    EXPECT_EQ(events[k].by, by) << k;
    EXPECT_FALSE(events[k].moves_fingers) << k;
  };
  // What falls is let go first; what goes from hand to hand is taken before.
  ASSERT_EQ(events.size(), 4U);
  is(0, Kind::Release, 1, {0, 2});
  is(1, Kind::Take, 0, {1, 4});
  is(2, Kind::Take, 2, {0, 2});
  is(3, Kind::Release, 2, {1, 4});
  EXPECT_EQ(held, held_in(after));
  EXPECT_TRUE(settling_events(after, held).empty());
}

TEST(Timeline, AWayWithoutABranchNamesThePlanThatIsMade) {
  std::vector<plan::Replan> replans(2);
  replans[1].plan = 1;
  std::set<std::string> plans;
  for (const json& way : ways_of(written("", replans), 0)) {
    EXPECT_EQ(way.contains("plan"), way["if"]["value"] == "false") << way;
    EXPECT_EQ(way["next"].is_null(), way.contains("plan")) << way;
    if (way.contains("plan")) plans.insert(way["plan"].dump());
  }
  EXPECT_EQ(plans, (std::set<std::string>{"1", "null"}));
}

}  // namespace
}  // namespace kaboum::execution
