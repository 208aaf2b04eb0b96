// Families of grasps: what is drawn is told from the object's side, by cylinder and plane
// coordinates of the tool's frame, which the library does not use.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/world/grasp_family.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "refused.h"

namespace kaboum::world {
namespace {

constexpr double kPi = std::numbers::pi;

/// The tool in the object's frame.
Eigen::Isometry3d tool_of(const Transform& grasp) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = grasp.linear;
  out.translation() = grasp.translation;
  return out.inverse();
}

/// A tool 5 cm beside an axis that is not the object's z, which looks askew at it.
Grasp round() {
  Grasp out{"round",
            {Eigen::Matrix3d(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized())),
             Vec3(0.02, -0.05, 0.1)}};
  const Vec3 axis = Vec3(0.2, -0.3, 1).normalized();
  out.turn = FreeTurn{{0.01, 0.02, -0.03}, axis, -1, 2.5};
  out.slides = {{axis, -0.02, 0.05}};
  return out;
}

/// A tool that may slide on the plane of two directions, and turn about its normal.
Grasp flat() {
  Grasp out{
      "flat",
      {Eigen::Matrix3d(Eigen::AngleAxisd(0.4, Vec3(3, 1, 0).normalized())), Vec3(0.01, 0, -0.02)}};
  out.slides = {{Vec3::UnitX(), -0.03, 0.04}, {Vec3(0.6, 0.8, 0), 0, 0.05}};
  out.turn = FreeTurn{tool_of(out.pose).translation(), Vec3::UnitZ()};
  return out;
}

/// Where a tool is about an axis: height, radius, azimuth of its origin, and its frame as seen
/// from there. Two tools that differ by a screw motion about the axis differ in height and azimuth
/// alone.
struct Cylinder {
  double height, radius, azimuth;
  Eigen::Matrix3d seen;
};
Cylinder about(const Eigen::Isometry3d& tool, const Vec3& point, const Vec3& axis) {
  const Vec3 x = Vec3::UnitX() - axis.x() * axis;
  const Vec3 u = x.normalized(), v = axis.cross(u), to = tool.translation() - point;
  const double azimuth = std::atan2(v.dot(to), u.dot(to));
  Eigen::Matrix3d frame;
  frame.col(0) = std::cos(azimuth) * u + std::sin(azimuth) * v;
  frame.col(1) = axis.cross(frame.col(0));
  frame.col(2) = axis;
  return {axis.dot(to), std::hypot(u.dot(to), v.dot(to)), azimuth,
          frame.transpose() * tool.linear()};
}

double turned_by(double from, double to, double low) {
  double out = std::remainder(to - from, 2 * kPi);
  while (out < low - 1e-9) out += 2 * kPi;
  return out;
}

bool is_same(const Transform& a, const Transform& b, double within) {
  return (a.translation - b.translation).norm() <= within && (a.linear - b.linear).norm() <= within;
}

TEST(GraspFamily, MembersGoRoundAnAxisAndAlongItWithinTheBounds) {
  const Grasp grasp = round();
  const FreeTurn& turn = *grasp.turn;
  const Cylinder stated = about(tool_of(grasp.pose), turn.point, turn.axis);
  double least = 10, most = -10, lowest = 10, highest = -10;
  for (std::size_t i = 0; i < 200; ++i) {
    const Transform member = member_of(grasp, draw_member(grasp, i));
    const Cylinder at = about(tool_of(member), turn.point, turn.axis);
    EXPECT_NEAR(at.radius, stated.radius, 1e-12);
    EXPECT_LT((at.seen - stated.seen).norm(), 1e-12);
    const double angle = turned_by(stated.azimuth, at.azimuth, -1), up = at.height - stated.height;
    EXPECT_LE(angle, 2.5 + 1e-9);
    EXPECT_GE(up, -0.02 - 1e-12);
    EXPECT_LE(up, 0.05 + 1e-12);
    least = std::min(least, angle), most = std::max(most, angle);
    lowest = std::min(lowest, up), highest = std::max(highest, up);
    EXPECT_TRUE(is_same(nearest_member(grasp, member), member, 1e-9)) << i;
    EXPECT_LE((tool_of(member).translation() - Vec3(0.3, -0.2, 0.1)).norm(),
              farthest_from(grasp, {0.3, -0.2, 0.1}));
  }
  EXPECT_TRUE(is_same(member_of(grasp, draw_member(grasp, 0)), grasp.pose, 1e-12));
  // All of it is drawn.
  EXPECT_LT(least, -0.9);
  EXPECT_GT(most, 2.4);
  EXPECT_LT(lowest, -0.018);
  EXPECT_GT(highest, 0.048);
}

TEST(GraspFamily, WhatIsNoMemberIsFarFromAll) {
  const Grasp grasp = round();
  const FreeTurn& turn = *grasp.turn;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1), any(-1, 1);
  int in = 0, out = 0;
  for (int i = 0; i < 3000; ++i) {
    // A screw about the axis by any values, within the bounds or not.
    const double angle = -1.4 + 4.4 * share(random), up = -0.04 + 0.11 * share(random);
    Eigen::Isometry3d screw = Eigen::Isometry3d::Identity();
    screw.translate(turn.point + up * turn.axis)
        .rotate(Eigen::AngleAxisd(angle, turn.axis))
        .translate(-turn.point);
    const Eigen::Isometry3d pose = (screw * tool_of(grasp.pose)).inverse();
    const Transform at{pose.linear(), pose.translation()};
    const bool within = angle >= -1 && angle <= 2.5 && up >= -0.02 && up <= 0.05;
    const double beyond = std::max({-1 - angle, angle - 2.5, -0.02 - up, up - 0.05, 0.0});
    EXPECT_EQ(is_same(nearest_member(grasp, at), at, 1e-7), within || beyond < 1e-8)
        << angle << ' ' << up;
    (within ? in : out)++;
    // Off the family in another way.
    const Vec3 aside = turn.axis.cross(Vec3(any(random), any(random), any(random))).normalized();
    Eigen::Isometry3d tilted = pose * Eigen::AngleAxisd(1e-4, aside);
    EXPECT_FALSE(is_same(nearest_member(grasp, {tilted.linear(), tilted.translation()}),
                         {tilted.linear(), tilted.translation()}, 1e-6));
    const Eigen::Isometry3d moved = pose * Eigen::Translation3d(1e-4 * aside);
    EXPECT_FALSE(is_same(nearest_member(grasp, {moved.linear(), moved.translation()}),
                         {moved.linear(), moved.translation()}, 1e-6));
  }
  EXPECT_GT(in, 500);
  EXPECT_GT(out, 500);
}

TEST(GraspFamily, MembersOnParallelFacesStayOnTheirPlane) {
  const Grasp grasp = flat();
  const Eigen::Isometry3d stated = tool_of(grasp.pose);
  for (std::size_t i = 0; i < 100; ++i) {
    const Transform member = member_of(grasp, draw_member(grasp, i));
    const Eigen::Isometry3d tool = tool_of(member);
    const Vec3 by = tool.translation() - stated.translation();
    EXPECT_NEAR(by.z(), 0, 1e-12);
    const double second = by.y() / 0.8, first = by.x() - 0.6 * second;
    EXPECT_GE(first, -0.03 - 1e-12);
    EXPECT_LE(first, 0.04 + 1e-12);
    EXPECT_GE(second, -1e-12);
    EXPECT_LE(second, 0.05 + 1e-12);
    const Eigen::Matrix3d turn = tool.linear() * stated.linear().transpose();
    EXPECT_NEAR(turn(2, 2), 1, 1e-12) << "about the normal";
    EXPECT_TRUE(is_same(nearest_member(grasp, member), member, 1e-9)) << i;
  }
  // The first member is as near to what is stated as the bounds allow.
  Grasp away = flat();
  away.slides[0] = {Vec3::UnitX(), 0.01, 0.04};
  away.turn->from = 1;
  away.turn->to = 2;
  EXPECT_EQ(draw_member(away, 0), (std::vector<double>{0.01, 0, 1}));
}

TEST(GraspFamily, AGraspOfNothingFreeIsItsPose) {
  const Grasp grasp{"one", {Eigen::Matrix3d::Identity(), {1, 2, 3}}};
  EXPECT_FALSE(is_family(grasp));
  EXPECT_TRUE(is_same(member_of(grasp, draw_member(grasp, 0)), grasp.pose, 0));
  EXPECT_TRUE(
      is_same(nearest_member(grasp, {Eigen::Matrix3d::Identity(), {0, 0, 0}}), grasp.pose, 0));
  EXPECT_NEAR(farthest_from(grasp, {-1, -2, 0}), 3, 1e-12);
}

class GraspScene : public ::testing::Test {
 protected:
  [[nodiscard]] std::string scene(const std::string& grasp) const {
    return files_.scene(
        R"("objects": [{"name": "mat", "shape": {"box": {"size": [1, 1, 1]}}}, {"name": "cup",
          "shape": {"cylinder": {"radius": 0.04, "length": 0.1}},
          "features": [{"name": "axis", "line": {"point": [0, 0, 1], "direction": [0, 0, 2]}},
                       {"name": "tip", "point": [0, 0, 0.05]}],
          "grasps": [)" +
            grasp + "]}]",
        R"("tools": [{"name": "hand", "link": "l3"}])");
  }
  void expect_refused(const std::string& grasp, const std::vector<std::string>& words) const {
    test::expect_refused(files_, scene(grasp), words);
  }
  test::SceneFiles files_;
};

TEST_F(GraspScene, IsReadWithItsFreedomsAndRank) {
  const World world = files_.world(scene(
      R"({"name": "hand/round", "position": [0.05, 0, 0], "turn": {"about": "cup/axis"},
          "slides": [{"along": "cup.z", "from": -0.01, "to": 0.02}], "rank": 2},
         {"name": "edge", "slides": [{"along": {"direction": [0, 3, 0]}, "from": 0, "to": 0}]},
         {"name": "part", "turn": {"about": "cup.xy", "from": -3.141592653589793, "to": 3.141592653589794}})"));
  const std::vector<Grasp>& grasps = world.objects[1].grasps;
  ASSERT_EQ(grasps.size(), 3U);
  EXPECT_EQ(grasps[0].turn->point, Vec3(0, 0, 1));
  EXPECT_EQ(grasps[0].turn->axis, Vec3::UnitZ());
  EXPECT_EQ(grasps[0].turn->from, -kPi);
  EXPECT_EQ(grasps[0].slides.at(0).to, 0.02);
  EXPECT_EQ(grasps[0].rank, 2U);
  EXPECT_EQ(grasps[1].slides.at(0).direction, Vec3::UnitY());
  EXPECT_EQ(grasps[1].rank, 0U);
  EXPECT_EQ(grasps[2].turn->axis, Vec3::UnitZ()) << "the normal";
}

TEST_F(GraspScene, WhatHasNoMembersOrNoAxisIsRefused) {
  const auto turn = [](const std::string& members) {
    return R"({"name": "g", "turn": {)" + members + "}}";
  };
  const auto slide = [](const std::string& members) {
    return R"({"name": "g", "slides": [{)" + members + "}]}";
  };
  expect_refused(turn(R"("about": "cup.z", "from": 1, "to": 0.5)"), {"'from' is above 'to'"});
  expect_refused(turn(R"("about": "cup.z", "from": 0, "to": 6.3)"), {"more than a whole turn"});
  expect_refused(turn(R"("about": "cup.z", "from": 1)"), {"give both"});
  expect_refused(turn(R"("about": "cup/axs")"),
                 {"no feature 'cup/axs'", "did you mean 'cup/axis'"});
  expect_refused(turn(R"("about": "cup/tip")"), {"is a point"});
  expect_refused(turn(R"("about": "mat.z")"), {"no feature of the object 'cup'"});
  expect_refused(turn(R"("about": "world.z")"), {"no feature of the object 'cup'"});
  expect_refused(turn(R"("about": {"direction": [0, 0, 0]})"), {"a direction of length 0"});
  expect_refused(turn(R"("abuot": "cup.z")"), {"'abuot' is not known", "about"});
  expect_refused(slide(R"("along": "cup.x", "from": 0.1, "to": 0)"), {"'from' is above 'to'"});
  expect_refused(slide(R"("along": "cup.x", "from": 0)"), {"'to' is missing"});
  expect_refused(slide(R"("along": "cup.x", "from": 0, "to": 1e300)"), {"-1e6 to 1e6"});
  expect_refused(
      slide(
          R"("along": "cup.x", "from": 0, "to": 1}, {"along": {"direction": [-1, 0, 0]}, "from": 0, "to": 1)"),
      {"two slides in one direction"});
  expect_refused(R"({"name": "g", "rank": -1})", {"a rank from 0 to 100"});
  expect_refused(R"({"name": "g", "rank": 0.5})", {"a rank from 0 to 100"});
  expect_refused(R"({"name": "hnd/g", "turn": {"about": "cup.z"}})",
                 {"no robot has the tool 'hnd'", "did you mean 'hand'"});
}

TEST_F(GraspScene, MayBeAllHoldsThatMeetConstraints) {
  // From the side, anywhere round the axis and between two heights: the tool's tip on the axis.
  const World world = files_.world(scene(
      R"({"name": "hand/side", "rank": 1, "all": [
          {"relation": "coincident", "first": "tool.origin", "second": "cup/axis", "within": 0.001},
          {"relation": "perpendicular", "first": "cup.z", "second": "tool.z", "within_angle": 0.01},
          {"relation": "distance", "first": "tool.origin", "second": "cup/tip", "value": 0.03, "within": 0.005}]})"));
  const Grasp& grasp = world.objects[1].grasps.at(0);
  EXPECT_TRUE(is_family(grasp));
  EXPECT_EQ(grasp.members.size(), kMostMembers);
  EXPECT_EQ(grasp.rank, 1U);
  double turned = 0;
  for (std::size_t i = 0; i < kMostMembers; ++i) {
    const Transform pose = drawn_member(grasp, i);
    // Where the tool is in the object's frame.
    const Vec3 tip = -(pose.linear.transpose() * pose.translation);
    const Vec3 z = pose.linear.transpose().col(2);
    EXPECT_LT(tip.head<2>().norm(), 1e-8) << i;
    EXPECT_NEAR(std::abs(tip.z() - 0.05), 0.03, 1e-8) << i;
    EXPECT_NEAR(z.z(), 0, 1e-8) << i;
    turned += z.x() > 0 ? 1 : 0;
    EXPECT_TRUE(is_same(nearest_member(grasp, pose), pose, 0)) << i;
    // Within the tolerances it is at a member, beyond it at none.
    for (const double off : {0.0009, 0.0011}) {
      Transform aside = pose;
      aside.translation += off * (pose.linear * Vec3::UnitX());
      EXPECT_EQ(is_same(nearest_member(grasp, aside), aside, 1e-9), off < 0.001) << i;
    }
    EXPECT_LE((tip - Vec3(1, 2, 3)).norm(), farthest_from(grasp, {1, 2, 3}));
  }
  EXPECT_GT(turned, kMostMembers / 4);
  EXPECT_LT(turned, 3 * kMostMembers / 4);
  // The same file gives the same members.
  EXPECT_TRUE(is_same(drawn_member(files_
                                       .world(scene(
                                           R"({"name": "hand/side", "rank": 1, "all": [
          {"relation": "coincident", "first": "tool.origin", "second": "cup/axis", "within": 0.001},
          {"relation": "perpendicular", "first": "cup.z", "second": "tool.z", "within_angle": 0.01},
          {"relation": "distance", "first": "tool.origin", "second": "cup/tip", "value": 0.03, "within": 0.005}]})"))
                                       .objects[1]
                                       .grasps.at(0),
                                   77),
                      drawn_member(grasp, 77), 0));
}

TEST_F(GraspScene, ConstraintsOfGraspsAreOfTheToolAndTheObject) {
  const auto all = [](const std::string& constraint, const std::string& more = "") {
    return R"({"name": "g", "all": [)" + constraint + "]" + more + "}";
  };
  const std::string one =
      R"({"relation": "coincident", "first": "tool.origin", "second": "cup/axis"})";
  expect_refused(all(one, R"(, "position": [0, 0, 1])"), {"has no 'position'"});
  expect_refused(all(one, R"(, "turn": {"about": "cup.z"})"), {"has no 'turn'"});
  expect_refused(all(""), {"at least one constraint"});
  expect_refused(
      all(R"({"relation": "coincident", "first": "tool.origin", "second": "cup/axis", "within": 1e-7})"),
      {"a tolerance of at least 1e-6"});
  expect_refused(all(R"({"relation": "coincident", "first": "tool.tip", "second": "cup/axis"})"),
                 {"a tool has the parts origin"});
  expect_refused(all(R"({"relation": "coincident", "first": "tool.origin", "second": "mat.z"})"),
                 {"neither a part of the tool"});
  expect_refused(all(R"({"relation": "coincident", "first": "cup.origin", "second": "cup/axis"})"),
                 {"fixed to the same thing"});
  expect_refused(
      all(one +
          R"(, {"relation": "distance", "first": "tool.origin", "second": "cup.z", "value": 0.1})"),
      {"contradict each other", "coincident 'tool.origin' 'cup/axis'"});
}

}  // namespace
}  // namespace kaboum::world
