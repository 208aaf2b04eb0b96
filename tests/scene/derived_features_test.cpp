// Derived grasps and places, against what boxes say: where rays along the fingers leave the object,
// and points of the object in the hand.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/scene/derived_features.h>
#include <kaboum/scene/scene_update.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "blocks.h"
#include "support/temporary_folder.h"

namespace kaboum::scene {
namespace {

TEST(Grasps, OfBoxesAreInTheMiddleOfParallelFaces) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> size(0.02, 0.2);
  for (int i = 0; i < 50; ++i) {
    const Vec3 half(size(random), size(random), size(random));
    const Transform frame = random_pose(random);
    const world::World world = world_with({{-half, half}}, 9, frame);
    for (const auto axis : {GraspRequest::Axis::X, GraspRequest::Axis::Y}) {
      GraspRequest request{.form = GraspRequest::Form::Poses,
                           .closing = axis,
                           .opening = 0.2,
                           .directions = 4,
                           .most = 100};
      const DerivedGrasps found = derive_grasps(world, 0, request);
      EXPECT_EQ(found.grasps.size(), 4 * (half.array() <= 0.1).count());
      for (const world::Grasp& grasp : found.grasps) {
        const Transform tool = tool_in_object(grasp);
        EXPECT_LT((tool.linear.transpose() * tool.linear - Eigen::Matrix3d::Identity()).norm(),
                  1e-9);
        EXPECT_GT(tool.linear.determinant(), 0);
        // In the box's own frame, whose axes are its normals.
        const Vec3 closing =
            frame.linear.transpose() * tool.linear.col(axis == GraspRequest::Axis::X ? 0 : 1);
        const Vec3 at = frame.linear.transpose() * (tool.translation - frame.translation);
        int along = 0;
        closing.cwiseAbs().maxCoeff(&along);
        EXPECT_NEAR(std::abs(closing[along]), 1, 1e-9);
        EXPECT_LE(half[along], 0.1);
        EXPECT_LT(at.norm(), 1e-9);  // no palm is near: the very middle
      }
    }
  }
}

TEST(Grasps, HaveAsMuchOfTheObjectOnEitherSideAndNoneAtCoveredFaces) {
  // An L of two boxes: where they touch no finger goes.
  const std::vector<Block> ell{{{0, 0, 0}, {0.25, 0.1, 0.1}}, {{0, 0.1, 0}, {0.1, 0.3, 0.1}}};
  const world::World world = world_with(ell, 9);
  GraspRequest request{.form = GraspRequest::Form::Poses, .directions = 1, .most = 100};
  const DerivedGrasps found = derive_grasps(world, 0, request);
  std::size_t across = 0;
  for (const world::Grasp& grasp : found.grasps) {
    const Transform tool = tool_in_object(grasp);
    const Vec3 closing = tool.linear.col(1);
    const double one = way_out(ell, tool.translation, closing),
                 other = way_out(ell, tool.translation, -closing);
    EXPECT_NEAR(one, other, 3e-4) << grasp.name << " " << tool.translation.transpose();
    EXPECT_GT(one, 0.01);
    if (std::abs(closing.y()) > 0.9) ++across;
  }
  EXPECT_GE(across, 2U);  // of the foot, and of both
  EXPECT_GE(found.grasps.size(), 5U);
  // Largest distances are kept.
  request.opening = 0.15;
  for (const world::Grasp& grasp : derive_grasps(world, 0, request).grasps) {
    const Transform tool = tool_in_object(grasp);
    EXPECT_LE(2 * way_out(ell, tool.translation, tool.linear.col(1)), 0.1502);
  }
}

TEST(Grasps, KeepTheHandFree) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> size(0.02, 0.4);
  std::size_t moved = 0, refused = 0;
  for (int i = 0; i < 40; ++i) {
    const Vec3 half(size(random), size(random), size(random));
    const Block box{-half, half};
    const double ahead = i % 2 == 0 ? 0.05 : -0.095;  // 0.15 and 0.005 before the palm
    world::World world = world_with({box}, ahead);
    // The wrist is fixed to the palm, and so part of the hand.
    const bool of_wrist = i % 4 < 2;
    if (of_wrist) world.robots[0].shapes[1].link = 1;
    const DerivedGrasps found =
        derive_grasps(world, 0, {.form = GraspRequest::Form::Poses, .directions = 4, .most = 100});
    refused += found.in_contact;
    EXPECT_EQ(found.grasps.size() + found.in_contact, 12U);
    if (found.in_contact > 0) {
      EXPECT_EQ(found.contact, of_wrist ? "arm/wrist" : "arm/palm");
    }
    for (const world::Grasp& grasp : found.grasps) {
      moved += grasp.pose.translation.norm() > 1e-9 ? 1 : 0;
      EXPECT_TRUE(box.holds((1 - 1e-9) * tool_in_object(grasp).translation));
      for (int k = 0; k < 2000; ++k) {
        const Vec3 p =
            half.cwiseProduct(Vec3(size(random), size(random), size(random)) / 0.2 - Vec3::Ones());
        const Vec3 in_hand = grasp.pose * p.cwiseMin(half).cwiseMax(-half) + Vec3(0, 0, ahead);
        EXPECT_FALSE(kPalm.holds(in_hand)) << grasp.name;
      }
    }
  }
  EXPECT_GT(moved, 20U);
  EXPECT_GT(refused, 20U);
}

TEST(Grasps, BySuctionAreAGapAwayFromTheFace) {
  const Vec3 half(0.1, 0.2, 0.3);
  const world::World world = world_with({{-half, half}}, 9, {}, 0.004);
  GraspRequest request{.hold = GraspRequest::Hold::Face,
                       .form = GraspRequest::Form::Poses,
                       .directions = 1,
                       .gap = 0.002};
  const DerivedGrasps found = derive_grasps(world, 0, request);
  ASSERT_EQ(found.grasps.size(), 6U);
  double before = 1;
  for (const world::Grasp& grasp : found.grasps) {
    const Transform tool = tool_in_object(grasp);
    const Vec3 normal = -tool.linear.col(2);
    int along = 0;
    normal.cwiseAbs().maxCoeff(&along);
    EXPECT_LT((tool.translation - (half[along] + 0.006) * normal).norm(), 1e-12);
    const double area = half.prod() / half[along];
    EXPECT_LE(area, before * (1 + 1e-9));  // the largest first
    before = area;
  }
  EXPECT_EQ(found.grasps.front().name, "tip/face-1");
  request.most = 2;
  EXPECT_EQ(derive_grasps(world, 0, request).grasps.size(), 2U);
}

TEST(Grasps, OfWhatHasNoParallelFacesAreNone) {
  world::World world = world_with({{{0, 0, 0}, {1, 1, 1}}}, 9);
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  world.objects[0].outer = {{{"body", *geom::convex_hull(corners)}}, collide::Direction::Outer, 0};
  EXPECT_EQ(derive_grasps(world, 0, {}).faces, 0U);
  EXPECT_EQ(derive_grasps(world, 0, {.hold = GraspRequest::Hold::Face}).faces, 4U);
}

TEST(Grasps, OfRoundBodiesAreAtTheirFlatFacesOnly) {
  world::World world = world_with({{{0, 0, 0}, {1, 1, 1}}}, 9);
  const auto faces = [&](std::vector<geom::ConvexBody> bodies, GraspRequest::Hold hold) {
    world.objects[0].outer = {std::move(bodies), collide::Direction::Outer, 0};
    return derive_grasps(
        world, 0,
        {.hold = hold, .form = GraspRequest::Form::Poses, .directions = 1, .most = 100, .gap = 0});
  };
  const auto round = [](std::vector<Vec3> core, double radius) {
    geom::ConvexBody out{"round", {}, radius};
    out.core.vertices = std::move(core);
    return out;
  };
  const geom::ConvexBody ball = round({Vec3::Zero()}, 0.1),
                         capsule = round({{0, 0, -0.2}, {0, 0, 0.2}}, 0.1);
  for (const auto hold : {GraspRequest::Hold::Sides, GraspRequest::Hold::Face}) {
    EXPECT_EQ(faces({ball}, hold).faces, 0U);
    EXPECT_EQ(faces({capsule}, hold).faces, 0U);
  }
  const Vec3 half(0.1, 0.2, 0.3);
  const geom::ConvexBody box{"box", hull_of({-half, half}, {}), 0.05};
  EXPECT_EQ(faces({box}, GraspRequest::Hold::Sides).faces, 3U);
  const DerivedGrasps found = faces({box}, GraspRequest::Hold::Face);
  ASSERT_EQ(found.grasps.size(), 6U);
  for (const world::Grasp& grasp : found.grasps) {
    const Transform tool = tool_in_object(grasp);
    const Vec3 normal = -tool.linear.col(2);
    int along = 0;
    normal.cwiseAbs().maxCoeff(&along);
    EXPECT_LT((tool.translation - (half[along] + 0.05) * normal).norm(), 1e-12);
  }
  // A ball on the middle of a face covers it.
  EXPECT_EQ(faces({box, round({{0, 0, 0.4}}, 0.08)}, GraspRequest::Hold::Face).faces, 5U);
  EXPECT_EQ(faces({box, round({{0, 0, 0.4}}, 0.04)}, GraspRequest::Hold::Face).faces, 6U);
  // A rounded corner does not where planes that are moved out would; nearer, each covers the other.
  geom::ConvexBody corner = box;
  for (Vec3& v : corner.core.vertices) v += half + Vec3(0.04, 0.04, 0.39);
  EXPECT_EQ(faces({box, corner}, GraspRequest::Hold::Face).faces, 12U);
  for (Vec3& v : corner.core.vertices) v -= Vec3(0.03, 0.03, 0.03);
  EXPECT_EQ(faces({box, corner}, GraspRequest::Hold::Face).faces, 10U);
}

TEST(Grasps, BySuctionAreTheLargestEpsilonOfTheHandAway) {
  const Vec3 half(0.1, 0.2, 0.3);
  world::World world = world_with({{-half, half}}, 9, {}, 0.004);
  world::RobotModel& arm = world.robots[0];
  // The tool is on a frame that is fixed to the palm; a finger moves against it.
  arm.kinematics.links.insert(arm.kinematics.links.end(), {{"frame", {}, {}}, {"finger", {}, {}}});
  arm.kinematics.joints.push_back(
      {.name = "to frame", .type = robot::JointType::Fixed, .parent = 2, .origin = {}});
  arm.kinematics.joints.push_back({.name = "j2",
                                   .type = robot::JointType::Revolute,
                                   .parent = 2,
                                   .origin = {},
                                   .axis = Vec3::UnitX(),
                                   .variable = 1});
  arm.kinematics.variables.push_back({"j2", -1.0, 1.0});
  arm.home.push_back(0);
  arm.tools[0].link = 3;
  arm.shapes[1].outer = set_of({kPalm}, {}, 0.002);
  arm.shapes.push_back({1, set_of({kPalm}, {}, 0.003), {}});
  arm.shapes.push_back({4, set_of({kPalm}, {}, 0.1), {}});
  const DerivedGrasps found = derive_grasps(world, 0,
                                            {.hold = GraspRequest::Hold::Face,
                                             .form = GraspRequest::Form::Poses,
                                             .directions = 1,
                                             .gap = 0.001});
  ASSERT_EQ(found.grasps.size(), 6U);
  for (const world::Grasp& grasp : found.grasps) {
    const Transform tool = tool_in_object(grasp);
    const Vec3 normal = -tool.linear.col(2);
    EXPECT_NEAR(normal.dot(tool.translation), half.dot(normal.cwiseAbs()) + 0.008, 1e-12);
  }
}

TEST(Grasps, SayWhatOfTheHandIsNotLookedAt) {
  world::World world = world_with({{{0, 0, 0}, {1, 1, 1}}}, 9);
  world::RobotModel& arm = world.robots[0];
  EXPECT_TRUE(derive_grasps(world, 0, {}).unchecked.empty());
  EXPECT_FALSE(derive_grasps(world, 0, {}).hand_unchecked);
  arm.kinematics.links[1].collision.emplace_back();  // but no set
  EXPECT_EQ(derive_grasps(world, 0, {}).unchecked, std::vector<std::string>{"arm/wrist"});
  EXPECT_FALSE(derive_grasps(world, 0, {}).hand_unchecked);
  const world::Item object{world::Item::kObject, 0}, palm{0, 1};
  for (const auto& pair : {std::array{object, palm}, std::array{palm, object}}) {
    world.allowed = {pair};
    const DerivedGrasps found = derive_grasps(world, 0, {});
    EXPECT_EQ(found.unchecked, (std::vector<std::string>{"arm/wrist", "arm/palm"}));
    EXPECT_TRUE(found.hand_unchecked);
  }
  world.allowed.clear();
  arm.kinematics.links[1].collision.clear();
  arm.shapes.pop_back();
  EXPECT_TRUE(derive_grasps(world, 0, {}).unchecked.empty());
  EXPECT_TRUE(derive_grasps(world, 0, {}).hand_unchecked);
}

/// A scene of an arm of frames and a box, in a folder.
std::filesystem::path scene_in(const std::filesystem::path& folder) {
  const std::string urdf =
      "<robot name='arm'><link name='base'/><link name='hand'/><joint name='j' type='fixed'>"
      "<parent link='base'/><child link='hand'/></joint></robot>";
  std::ofstream(folder / "arm.urdf") << urdf;
  const std::filesystem::path out = folder / "cell.json";
  std::ofstream(out) << R"({"kaboum_scene": 1, "unit": "m", "robots": [{"name": "arm", "urdf":)"
                     << R"({"file": "arm.urdf", "sha256": ")"
                     << io::sha256(std::vector<char>(urdf.begin(), urdf.end()))
                     << R"("}, "links": [], "tools": [{"name": "tip", "link": "hand"}]}],)"
                     << R"("objects": [{"name": "b", "shape": {"box": {"size": [0.03, 0.07, 0.2]}})"
                     << R"(}], "regions": [{"name": "r", "inner": {"file": "sub/r.glb"}}]})";
  return out;
}

void expect_same(const world::Grasp& a, const world::Grasp& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.pose.linear, b.pose.linear);
  EXPECT_EQ(a.pose.translation, b.pose.translation);
  EXPECT_EQ(a.rank, b.rank);
  ASSERT_EQ(a.slides.size(), b.slides.size());
  for (std::size_t i = 0; i < a.slides.size(); ++i) {
    EXPECT_EQ(a.slides[i].direction, b.slides[i].direction);
    EXPECT_EQ(a.slides[i].from, b.slides[i].from);
    EXPECT_EQ(a.slides[i].to, b.slides[i].to);
  }
  ASSERT_EQ(a.turn.has_value(), b.turn.has_value());
  if (!a.turn) return;
  EXPECT_EQ(a.turn->point, b.turn->point);
  EXPECT_EQ(a.turn->axis, b.turn->axis);
  EXPECT_EQ(a.turn->from, b.turn->from);
  EXPECT_EQ(a.turn->to, b.turn->to);
}

TEST(Grasps, AreDecidedAsTheyAreRead) {
  const test::TemporaryFolder folder;
  const std::filesystem::path scene = scene_in(folder.path());
  const std::vector<std::string> named = files_of(scene);
  EXPECT_EQ(named, (std::vector<std::string>{scene.string(), (folder.path() / "arm.urdf").string(),
                                             (folder.path() / "sub/r.glb").string()}));
  // Without the region, whose file is not there.
  std::string text = [&] {
    const std::vector<char> bytes = io::read_file(scene);
    return std::string(bytes.begin(), bytes.end());
  }();
  text.erase(text.find(", \"regions\""));
  std::ofstream(scene) << text << "}";
  using R = GraspRequest;
  for (const auto& [hold, form] :
       {std::pair(R::Hold::Sides, R::Form::Poses), std::pair(R::Hold::Face, R::Form::Poses),
        std::pair(R::Hold::Sides, R::Form::Families),
        std::pair(R::Hold::Face, R::Form::Families)}) {
    const GraspRequest request{.hold = hold, .form = form, .directions = 7, .most = 100};
    const AddedFeatures added = add_grasps(scene, {}, request);
    ASSERT_EQ(added.objects.size(), 1U);
    EXPECT_NE(added.objects[0].shortfall.find("nothing that moves with tool 'tip' has a set"),
              std::string::npos);
    const world::World world = world::read_scene(scene.string()).world;
    const DerivedGrasps again = derive_grasps(world, 0, request);
    std::vector<world::Grasp> read;
    for (const world::Grasp& grasp : world.objects[0].grasps)
      if (std::ranges::find(added.objects[0].names, grasp.name) != added.objects[0].names.end())
        read.push_back(grasp);
    ASSERT_EQ(read.size(), again.grasps.size());
    ASSERT_EQ(read.size(), (form == R::Form::Poses ? 7U : 1U) * (hold == R::Hold::Sides ? 3U : 6U));
    for (std::size_t i = 0; i < read.size(); ++i) expect_same(read[i], again.grasps[i]);
  }
}

TEST(Grasps, NameWhatIsNotThere) {
  world::World world = world_with({{{0, 0, 0}, {1, 1, 1}}}, 9);
  const auto refused = [&](const GraspRequest& request) -> std::string {
    try {
      derive_grasps(world, 0, request);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_NE(refused({.tool = "tipp"}).find("no tool 'tipp'; did you mean 'tip'"),
            std::string::npos);
  EXPECT_NE(refused({.robot = "harm"}).find("harm"), std::string::npos);
  EXPECT_NE(refused({.directions = 0}).find("directions"), std::string::npos);
  world.robots[0].tools.push_back({"other", 2, {}});
  EXPECT_NE(refused({}).find("several tools: name one of tip, other"), std::string::npos);
  world.robots[0].tools.clear();
  EXPECT_NE(refused({}).find("no tools"), std::string::npos);
}

/// Twice the area of an outline, along its normal.
Vec3 area_of(const std::vector<Vec3>& outline) {
  Vec3 out = Vec3::Zero();
  for (std::size_t k = 0; k < outline.size(); ++k)
    out += (outline[k] - outline[0]).cross(outline[(k + 1) % outline.size()] - outline[0]);
  return out;
}

void expect_outline(const world::Feature& feature, const std::vector<Vec3>& corners, double area) {
  ASSERT_EQ(feature.kind, world::Feature::Kind::Surface);
  EXPECT_EQ(feature.outline.size(), corners.size()) << feature.name;
  for (const Vec3& corner : corners)
    EXPECT_TRUE(std::ranges::any_of(feature.outline,
                                    [&](const Vec3& p) { return (p - corner).norm() < 1e-9; }))
        << feature.name << " " << corner.transpose();
  EXPECT_NEAR(area_of(feature.outline).norm() / 2, area, 1e-9);
}

TEST(Places, AreWhereTheObjectStandsAndWhatLooksUp) {
  // An L that stands on its side: its y is up.
  const std::vector<Block> ell{{{0, 0, 0}, {0.25, 0.1, 0.1}}, {{0, 0.1, 0}, {0.1, 0.3, 0.1}}};
  world::World world = world_with(ell, 9);
  world.objects[0].pose.linear =
      Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitX()).toRotationMatrix();
  const std::vector<world::Feature> found = derive_places(world, 0, {});
  ASSERT_EQ(found.size(), 5U);
  EXPECT_EQ(found[0].name, "bottom");
  EXPECT_LT((found[0].point - Vec3(0.125, 0, 0.05)).norm(), 1e-9);
  EXPECT_EQ(found[1].name, "top");
  EXPECT_LT((found[1].point - Vec3(0.125, 0.1, 0.05)).norm(), 1e-9);
  EXPECT_EQ(found[2].name, "top2");
  EXPECT_LT((found[2].point - Vec3(0.05, 0.3, 0.05)).norm(), 1e-9);
  EXPECT_EQ(found[3].name, "face");
  // Of the foot, what the other box leaves; then that box.
  expect_outline(found[3], {{0.1, 0.1, 0}, {0.1, 0.1, 0.1}, {0.25, 0.1, 0.1}, {0.25, 0.1, 0}},
                 0.015);
  EXPECT_EQ(found[4].name, "face2");
  expect_outline(found[4], {{0, 0.3, 0}, {0, 0.3, 0.1}, {0.1, 0.3, 0.1}, {0.1, 0.3, 0}}, 0.01);
  EXPECT_EQ(derive_places(world, 0, {.most = 1}).size(), 3U);
  // On its edge it has neither.
  world.objects[0].pose.linear =
      Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  EXPECT_TRUE(derive_places(world, 0, {}).empty());
}

TEST(Places, OfWhatIsAttachedAreAsItsRobotHoldsIt) {
  const Vec3 half(0.1, 0.2, 0.3);
  world::World world = world_with({{-half, half}}, 9);
  world.objects[0].pose.linear = Eigen::AngleAxisd(0.5, Vec3::UnitX()).toRotationMatrix();
  EXPECT_TRUE(derive_places(world, 0, {}).empty());
  world::Attachment held{.robot = 0, .link = 2, .pose = {}, .touching = {}};
  held.pose.linear = Eigen::AngleAxisd(std::acos(-1.0), Vec3::UnitX()).toRotationMatrix();
  world.attachments[0] = held;
  const std::vector<world::Feature> found = derive_places(world, 0, {});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_LT((found[0].point - Vec3(0, 0, 0.3)).norm(), 1e-9);  // upside down
  EXPECT_LT((found[1].point - Vec3(0, 0, -0.3)).norm(), 1e-9);
  // The robot is turned with its base.
  world.robots[0].base.linear = Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix();
  EXPECT_TRUE(derive_places(world, 0, {}).empty());
}

TEST(Places, OfRoundBodiesAreOnTheirFlatFacesOnly) {
  world::World world = world_with({{{0, 0, 0}, {1, 1, 1}}}, 9);
  geom::ConvexBody capsule{"capsule", {}, 0.1};
  capsule.core.vertices = {{-0.2, 0, 0.1}, {0.2, 0, 0.1}};
  world.objects[0].outer = {{capsule}, collide::Direction::Outer, 0};
  EXPECT_TRUE(derive_places(world, 0, {}).empty());
  const Vec3 half(0.1, 0.2, 0.3);
  const geom::ConvexBody box{"box", hull_of({-half, half}, {}), 0.05};
  world.objects[0].outer = {{box}, collide::Direction::Outer, 0};
  const std::vector<world::Feature> found = derive_places(world, 0, {});
  ASSERT_EQ(found.size(), 3U);
  expect_outline(
      found[2], {{-0.1, -0.2, 0.35}, {0.1, -0.2, 0.35}, {0.1, 0.2, 0.35}, {-0.1, 0.2, 0.35}}, 0.08);
  EXPECT_LT((found[0].point - Vec3(0, 0, -0.35)).norm(), 1e-12);
  EXPECT_LT((found[1].point - Vec3(0, 0, 0.35)).norm(), 1e-12);
  // It stands on a ball, not on the box.
  geom::ConvexBody ball{"ball", {}, 0.2};
  ball.core.vertices = {{0, 0, -0.25}};
  world.objects[0].outer = {{box, ball}, collide::Direction::Outer, 0};
  ASSERT_EQ(derive_places(world, 0, {}).size(), 2U);
  EXPECT_EQ(derive_places(world, 0, {})[0].name, "top");
}

}  // namespace
}  // namespace kaboum::scene
