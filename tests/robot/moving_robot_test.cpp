// Robots in motion as the verifier takes them.
#include <gtest/gtest.h>
#include <kaboum/verify/moving_robot.h>

#include "robots.h"
#include "support/shapes.h"

namespace kaboum::test {
namespace {

using verify::Answer;
using verify::MovingShape;

Geometry sphere() {
  Geometry g;
  g.shape = Geometry::Shape::Sphere;
  g.origin.translation = {0.1, 0.2, 0.3};
  return g;
}

TEST(MovingRobot, PosesAreThoseOfTheKinematics) {
  std::mt19937_64 random(5);
  for (const TestRobot& test : {six_axis_arm(), prismatic_chain()}) {
    const Robot& robot = test.robot;
    const Path path = random_path(robot, random, 5, 3, false);
    std::vector<MovingShape> shapes;
    std::vector<std::uint32_t> links;
    for (std::uint32_t l = 0; l < robot.links.size(); ++l) {
      shapes.push_back(*verify::moving_shape(robot, l, sphere()));
      links.push_back(l);
      for (const auto& q : path) {
        const Transform expected = reference_pose(robot, l, q);
        const auto pose = verify::pose_of(shapes.back().chain, q);
        EXPECT_LT(
            (pose.col(3) - (expected.linear * sphere().origin.translation + expected.translation))
                .norm(),
            1e-12)
            << test.name << ", link " << l;
      }
    }
    EXPECT_TRUE(verify::same_poses(robot, shapes, links, path)) << test.name;
    shapes.back().chain.front().translation.x() += 1e-6;
    EXPECT_FALSE(verify::same_poses(robot, shapes, links, path)) << test.name;
  }
}

TEST(MovingRobot, Shapes) {
  const Robot robot = six_axis_arm().robot;
  Geometry g = sphere();
  g.size.setZero();
  EXPECT_FALSE(verify::moving_shape(robot, 1, g));  // a point
  g.shape = Geometry::Shape::Cylinder;
  g.size = {0, 2, 0};
  const auto line = verify::moving_shape(robot, 1, g);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->kind, MovingShape::Kind::Box);
  EXPECT_EQ(line->size, Vec3(0, 0, 2));
  g.size = {1, 2, 0};
  EXPECT_EQ(verify::moving_shape(robot, 1, g)->kind, MovingShape::Kind::Cylinder);
}

// A mirrored solid is still a solid.
TEST(MovingRobot, ScaledMeshesKeepTheirVolume) {
  const Robot robot = six_axis_arm().robot;
  Geometry g;
  g.shape = Geometry::Shape::Mesh;
  for (const Vec3& scale : {Vec3(2, 1, 1), Vec3(-2, 1, 1), Vec3(-2, -1, 1)}) {
    g.size = scale;
    const auto shape = verify::moving_shape(robot, 1, g, box({1, 1, 1}, 1));
    EXPECT_NEAR(geom::signed_volume(shape->mesh), 2, 1e-12);
  }
}

TEST(MovingRobot, ConfigurationWithinASegment) {
  const Path path{{0, 4}, {2, 8}};
  verify::SweepPlace place;
  place.s = 0.25;
  EXPECT_EQ(verify::configuration_at(path, place), (std::vector<double>{0.5, 5}));
  place.segment = 1;  // the last waypoint alone
  EXPECT_EQ(verify::configuration_at(path, place), path[1]);
}

TEST(MovingRobot, ClaimsThatDecide) {
  using enum Answer;
  verify::SweepClaims found;
  found.convex.answer = found.surface.answer = Verified;
  EXPECT_EQ(answer_of(found, verify::Claims::All), Verified);  // no mesh is closed
  found.solid.answer = Refuted;
  EXPECT_EQ(answer_of(found, verify::Claims::All), Refuted);
  EXPECT_EQ(answer_of(found, verify::Claims::Surface), Verified);
  found.convex.answer = Undecided;
  EXPECT_EQ(answer_of(found, verify::Claims::Surface), Undecided);
}

}  // namespace
}  // namespace kaboum::test
