// What counts as pushed when a plan is carried out.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "simulation_state.h"

namespace kaboum::execution {
namespace {

using geom::Transform;
using geom::Vec3;
using Kind = world::Feature::Kind;

constexpr double kGap = 0.002;

/// Which way a hand pushes a box of 0.1 m that lies on its side, rolled about x by an angle.
std::optional<Vec3> way_of(double roll, double gap = 0.001, double aside = 0) {
  world::World world;
  world.robots.resize(1);
  world.robots[0].features = {{1, {"push", Kind::Plane, {0.05, 0, 0}, {1, 0, 0}}}};
  world.objects.push_back({"box",
                           {},
                           {{}, collide::Direction::Outer, 0},
                           {},
                           {{"top", Kind::Plane, {0, 0, 0.05}, {0, 0, 1}},
                            {"push", Kind::Plane, {0, 0, -0.05}, {0, 0, -1}}},
                           {}});
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(roll, Vec3::UnitX()).toRotationMatrix();
  // Rolled by a right angle, the lower side of the box looks along y: the hand pushes along -y.
  const Transform object{turned, {0.4, 0.3, 0.05}},
      hand{Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitZ()).toRotationMatrix(),
           object * Vec3(0, 0, -0.05) + Vec3(aside, 0.05 + gap, 0)};
  return pushed_way(world, 0, 1, hand, 0, object, kGap);
}

TEST(PushedWay, PlanesAsLevelAsObjectsAreFaceEachOther) {
  constexpr double kRight = std::numbers::pi / 2;
  for (const double roll : {kRight, 1.5708, 1.57075, kRight - 9e-5, kRight + 9e-5}) {
    const auto way = way_of(roll);
    ASSERT_TRUE(way) << roll;
    EXPECT_LT((*way + Vec3::UnitY()).norm(), 1e-12);
  }
  for (const double roll : {kRight - 1.2e-4, kRight + 1.2e-4, 1.5, -kRight, 0.0})
    EXPECT_FALSE(way_of(roll)) << roll;
}

TEST(PushedWay, PlanesAreNearAndOppositeEachOther) {
  constexpr double kRight = std::numbers::pi / 2;
  EXPECT_TRUE(way_of(kRight, kGap - 1e-9));
  EXPECT_FALSE(way_of(kRight, kGap + 1e-9));
  EXPECT_FALSE(way_of(kRight, -1e-4));
  EXPECT_FALSE(way_of(kRight, 0.001, 1e-5));
}

}  // namespace
}  // namespace kaboum::execution
