// The judge against rational numbers, before it judges others.

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>
#include <kaboum/judge/solid.h>
#include <kaboum/robot/kinematics.h>

#include "collide/pairs.h"
#include "support/rational_contact.h"
#include "support/shapes.h"

namespace kaboum::judge {
namespace {

TEST(ExactJudge, SaysWhatRationalNumbersSay) {
  std::mt19937_64 random(11);
  int meet = 0, inside = 0;
  for (int i = 0; i < 60; ++i) {
    geom::Mesh a = test::random_body(random, 0.3);
    const geom::Mesh b = test::random_body(random, 0.3);
    if (i % 5 == 0)
      for (geom::Vec3& v : a.vertices)
        v = 0.05 * (v - a.vertices[0]) + 0.25 * b.vertices[0] + 0.25 * b.vertices[1] +
            0.25 * b.vertices[2] + 0.25 * b.vertices[3];
    const geom::Transform pose = i % 5 == 0 ? geom::Transform{} : test::random_pose(random, 0.5);
    const Solid x(a), y(b);
    EXPECT_TRUE(x.closed());
    const bool expected = test::rational_within(a, {}, b, pose, 0);
    EXPECT_EQ(x.meets({}, y, pose), expected) << i;
    EXPECT_EQ(y.meets(pose, x, {}), expected) << i;
    for (const double reach : {0.05, 0.4}) {
      if (expected) break;
      EXPECT_EQ(x.is_within({}, y, pose, reach), test::rational_within(a, {}, b, pose, reach)) << i;
    }
    meet += expected ? 1 : 0;
    inside += expected && i % 5 == 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 8);
  EXPECT_GT(meet - inside, 8);
  EXPECT_LT(meet, 50);
}

TEST(ExactJudge, InsideOfAnOpenMeshIsNothing) {
  std::mt19937_64 random(12);
  geom::Mesh large = test::random_body(random, 0);
  geom::Mesh small = large;
  geom::Vec3 middle = geom::Vec3::Zero();
  for (const geom::Vec3& v : large.vertices)
    middle += v / static_cast<double>(large.vertices.size());
  for (geom::Vec3& v : small.vertices) v = middle + 0.1 * (v - middle);
  EXPECT_TRUE(Solid(large).meets({}, Solid(small), {}));
  large.triangles.pop_back();
  EXPECT_FALSE(Solid(large).closed());
  EXPECT_FALSE(Solid(large).meets({}, Solid(small), {}));
}

TEST(ExactJudge, DepthIsThatOfThePointFarthestInside) {
  const auto box = [](const geom::Vec3& size) {
    geom::Mesh mesh = test::box(size, 1);
    for (geom::Vec3& v : mesh.vertices) v -= 0.5 * size;
    return Solid(mesh);
  };
  const Solid large = box({1, 1, 1}), small = box({0.2, 0.2, 0.2});
  geom::Transform at, turned;
  turned.linear = Eigen::AngleAxisd(0.5 * M_PI, geom::Vec3::UnitZ()).toRotationMatrix();
  turned.translation = {5, 0, 0};
  const auto depth = [&](double y, double step) {
    at.translation = geom::Vec3(5, y, 0);
    const double one = small.depth(at, large, turned, step);
    EXPECT_EQ(large.depth(turned, small, at, step), one);
    return one;
  };
  EXPECT_NEAR(depth(0, 1), 0.4, 1e-12);      // its corners, 0.1 from the middle
  EXPECT_NEAR(depth(0.55, 1), 0.05, 1e-12);  // reaches in by 0.05
  EXPECT_NEAR(depth(0.4, 1), 0.2, 1e-12);
  EXPECT_EQ(depth(0.7, 1), 0);
  // A face through which the other one goes: no corner is inside of either.
  const Solid rod = box({0.1, 0.1, 4});
  EXPECT_EQ(rod.depth({}, large, {}, 10), 0);
  EXPECT_NEAR(rod.depth({}, large, {}, 0.01), 0.45, 0.01);
}

TEST(ExactJudge, PlacesLinksAsKinematicsDoes) {
  const robot::Robot robot = robot::parse_urdf(R"(<robot name="r"><link name="a"/><link name="b"/>
    <link name="c"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/>
    <origin xyz="1 2 3" rpy="0.1 0.2 0.3"/><axis xyz="1 2 2"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="k" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0.6 0.8"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>)",
                                               "test");
  std::mt19937_64 random(13);
  const geom::Transform base{test::random_rotation(random), {4, 5, 6}};
  const std::vector<double> q{0.7, -0.4};
  const auto expected = robot::forward(robot, q), found = places(robot, base, q);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const geom::Transform there = base * expected[i];
    EXPECT_LT((found[i].linear - there.linear).norm(), 1e-14);
    EXPECT_LT((found[i].translation - there.translation).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace kaboum::judge
