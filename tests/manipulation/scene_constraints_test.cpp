// Constraints between features of a scene: samples judged by the scene's own kinematics.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/manipulation/scene_constraints.h>
#include <kaboum/robot/kinematics.h>

#include "worlds.h"

namespace kaboum::manipulation {
namespace {

using kinematics::Relation;
using test::SceneFiles;

/// The arm with features on two links, a table that stands, a cup that is sought, a tag that the
/// second link carries.
world::World cell() {
  const SceneFiles files;
  const std::string outer = ", \"outer\": " + files.ref("box.glb");
  return files.world(files.scene(
      R"("objects": [
      {"name": "table", "pose": {"position": [1, 1, -2], "rpy": [0, 0, 1]})" +
          outer +
          R"(, "features": [{"name": "top", "plane": {"point": [0, 0, 1.5], "normal": [0, 0, 1]}},
                            {"name": "edge", "line": {"point": [0.5, 0, 2.5], "direction": [0, 1, 0]}}]},
      {"name": "cup")" +
          outer + R"(, "features": [{"name": "bottom", "point": [0, 0, -0.5]}]},
      {"name": "tag")" +
          outer + R"(, "features": [{"name": "middle", "point": [0, 0, 0]}]}],
      "attachments": [{"object": "tag", "robot": "arm", "link": "l2", "position": [0.5, 0.25, 0]}])",
      R"("base": {"position": [0.25, 0, 0.5], "rpy": [0, 0, 0.5]},
      "tools": [{"name": "flange", "link": "l3", "position": [1, 0, 0]}],
      "features": [{"name": "elbow", "link": "l2", "point": [0, 0, 0]},
                   {"name": "tip", "link": "l3", "point": [1, 0, 0]},
                   {"name": "tip", "link": "l3", "line": {"point": [1, 0, 0], "direction": [1, 0, 0]}},
                   {"name": "front", "link": "l3", "plane": {"point": [1, 0, 0], "normal": [1, 0, 0]}}])"));
}

TEST(SceneConstraints, SamplesMeetThemByTheScenesKinematics) {
  const world::World world = cell();
  SceneConstraints scene(world, {{"arm", "flange"}}, {"cup"});
  const auto elbow = scene.feature("arm/elbow"), front = scene.feature("arm/front"),
             tag = scene.feature("tag/middle"), edge = scene.feature("table/edge"),
             top = scene.feature("table/top"), bottom = scene.feature("cup/bottom");
  scene.problem().constraints = {{Relation::Distance, elbow, edge, 1},
                                 {Relation::Coincident, bottom, top},
                                 {Relation::Distance, bottom, tag, 1.5},
                                 {Relation::Coincident, bottom, front}};
  kinematics::ConstraintSampler sampler(scene.problem(), {.draws = 500});
  const world::RobotModel& arm = world.robots[0];
  for (int i = 0; i < 10; ++i) {
    const auto sample = sampler.next();
    ASSERT_TRUE(sample) << i;
    const auto poses = robot::forward(arm.kinematics, sample->at.joints[0]);
    const auto at = [&](const char* link, const geom::Vec3& p) {
      return geom::Vec3(arm.base * (poses[*arm.kinematics.find_link(link)] * p));
    };
    const geom::Transform& table = world.objects[0].pose;
    const geom::Vec3 along = table.linear * geom::Vec3::UnitY(),
                     from = at("l2", {0, 0, 0}) - table * geom::Vec3(0.5, 0, 2.5);
    EXPECT_NEAR((from - along * along.dot(from)).norm(), 1, 1e-8);
    const geom::Vec3 cup = sample->at.objects[0] * geom::Vec3(0, 0, -0.5);
    EXPECT_NEAR(cup.z(), -0.5, 1e-8);
    EXPECT_NEAR((cup - at("l2", {0.5, 0.25, 0})).norm(), 1.5, 1e-8);
    const geom::Vec3 tip = at("l3", {1, 0, 0});
    EXPECT_NEAR((cup - tip).dot(tip - at("l3", {0, 0, 0})), 0, 1e-8);
  }
}

TEST(SceneConstraints, OtherRobotsStayAtHome) {
  const world::World world = cell();
  SceneConstraints scene(world, {}, {"cup"});
  const auto tip = scene.feature("arm/elbow");
  EXPECT_EQ(tip.frame, kinematics::FrameId{});
  const world::RobotModel& arm = world.robots[0];
  const geom::Vec3 expected =
      arm.base *
      robot::forward(arm.kinematics, arm.home)[*arm.kinematics.find_link("l2")].translation;
  EXPECT_LT((std::get<kinematics::Point>(tip.feature).position - expected).norm(), 1e-12);
}

TEST(SceneConstraints, WhatTheSceneDoesNotHaveIsRefused) {
  const world::World world = cell();
  SceneConstraints scene(world, {{"arm", "l2"}}, {});
  const auto refused = [&](const auto& call, const std::string& words) {
    try {
      call();
      ADD_FAILURE() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refused([&] { scene.feature("nothing"); }, "OBJECT/FEATURE or ROBOT/FEATURE");
  refused([&] { scene.feature("table/tap"); }, "did you mean 'table/top'");
  refused([&] { scene.feature("arn/tip"); }, "did you mean 'arm/tip'");
  refused([&] { scene.feature("arm/tip"); }, "two kinds");
  refused([&] { scene.feature("arm/front"); }, "which is not the arm's");  // beyond the chain
  refused([&] { SceneConstraints(world, {}, {"tag"}); }, "is carried");
  refused([&] { SceneConstraints(world, {}, {"cop"}); }, "no object 'cop'");
  refused([&] { SceneConstraints(world, {{"arm", "nobody"}}, {}); }, "nobody");
}

}  // namespace
}  // namespace kaboum::manipulation
