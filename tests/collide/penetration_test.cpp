// Penetration depths against the hull of all differences, facet by facet.

#include <gtest/gtest.h>
#include <kaboum/collide/penetration.h>
#include <kaboum/geom/convex_hull.h>

#include <cmath>
#include <limits>
#include <vector>

#include "pairs.h"
#include "support/shapes.h"

namespace kaboum::collide {
namespace {

using geom::Transform;
using geom::Vec3;

/// The depth by brute force: the nearest facet of the hull of all differences of corners. Rounded;
/// negative where the bodies are apart; NaN where the hull is flat.
double depth_by_hull(const geom::Mesh& a, const Transform& pose_a, const geom::Mesh& b,
                     const Transform& pose_b) {
  std::vector<Vec3> differences;
  for (const Vec3& p : a.vertices)
    for (const Vec3& q : b.vertices) differences.emplace_back(pose_a * p - pose_b * q);
  const auto hull = geom::convex_hull(differences);
  if (!hull) return std::numeric_limits<double>::quiet_NaN();
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : hull->triangles) {
    const Vec3 &u = hull->vertices[i], &v = hull->vertices[j], &w = hull->vertices[k];
    const Vec3 normal = (v - u).cross(w - u);
    // Slivers have no direction; others bound the same facet.
    if (normal.norm() < 1e-9 * (v - u).norm() * (w - u).norm()) continue;
    least = std::min(least, normal.dot(u) / normal.norm());
  }
  return least;
}

geom::Mesh cube(double size) { return test::box(Vec3::Constant(size), 1); }

BoundingSet set_of(const std::vector<geom::ConvexBody>& bodies) {
  return {bodies, Direction::Outer, 0};
}

TEST(PenetrationBetween, BracketsTheDepthByTheHullOfAllDifferences) {
  std::mt19937_64 random(7);
  int deep = 0;
  for (int i = 0; i < 1500; ++i) {
    const geom::Mesh a = test::random_body(random, 0.3), b = test::random_body(random, 0.3);
    const Transform pose_a = test::random_pose(random, 0.2),
                    pose_b = test::random_pose(random, 0.2);
    const double expected = depth_by_hull(a, pose_a, b, pose_b);
    ASSERT_FALSE(std::isnan(expected));
    const Polytope body_a(a.vertices), body_b(b.vertices);
    const Penetration found = penetration_between(Posed(body_a, pose_a), Posed(body_b, pose_b));
    if (expected < -1e-12) {
      EXPECT_EQ(found.lower, 0) << i;
      EXPECT_EQ(found.upper, 0) << i;
      continue;
    }
    ++deep;
    EXPECT_LE(found.lower, expected + 1e-12) << i;
    EXPECT_GE(found.upper, expected - 1e-12) << i;
    EXPECT_LE(found.upper - found.lower, 1e-8) << i;
    // The direction parts them.
    Transform moved = pose_b;
    moved.translation += (found.upper + 1e-9) * found.direction;
    EXPECT_FALSE(are_within(Posed(body_a, pose_a), Posed(body_b, moved), 0)) << i;
    moved.translation = pose_b.translation + (found.lower - 1e-6) * found.direction;
    if (found.lower > 1e-6) {
      EXPECT_TRUE(are_within(Posed(body_a, pose_a), Posed(body_b, moved), 0)) << i;
    }
  }
  EXPECT_GT(deep, 500);
}

TEST(PenetrationBetween, OfCubesIsTheShortestWayOut) {
  const Polytope body(cube(1).vertices);
  const Transform here;
  for (const double shift : {0.25, 0.5, 0.96875}) {
    const Transform there{Eigen::Matrix3d::Identity(), Vec3(shift, 0, 0)};
    const Penetration found = penetration_between(Posed(body, here), Posed(body, there));
    EXPECT_NEAR(found.lower, 1 - shift, 1e-12);
    EXPECT_NEAR(found.upper, 1 - shift, 1e-12);
    EXPECT_LE(found.lower, 1 - shift);
    EXPECT_GE(found.upper, 1 - shift);
    EXPECT_NEAR(found.direction.x(), 1, 1e-12);
  }
  // All at the same place: as deep as it is wide.
  EXPECT_NEAR(penetration_between(Posed(body, here), Posed(body, here)).lower, 1, 1e-12);
}

TEST(PenetrationBetween, TouchingAndFlatBodiesHaveNoDepth) {
  const Polytope body(cube(1).vertices), sheet(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const Transform here, beside{Eigen::Matrix3d::Identity(), Vec3(1, 0, 0)},
      within{Eigen::Matrix3d::Identity(), Vec3(0.25, 0, 0.375)};
  const Penetration touching = penetration_between(Posed(body, here), Posed(body, beside));
  EXPECT_EQ(touching.lower, 0);
  EXPECT_LE(touching.upper, 1e-12);
  const Penetration flat = penetration_between(Posed(sheet, here), Posed(sheet, here));
  EXPECT_EQ(flat.lower, 0);
  EXPECT_LE(flat.upper, 1e-12);
  // A sheet has to leave the cube by the nearest side.
  const Penetration found = penetration_between(Posed(body, here), Posed(sheet, within));
  EXPECT_NEAR(found.lower, 0.375, 1e-9);
  EXPECT_NEAR(found.upper, 0.375, 1e-9);
}

TEST(Penetration, OfBallsIsTheSumOfRadiiLessTheDistance) {
  const auto ball = [](double radius) {
    geom::Mesh core;
    core.vertices = {Vec3::Zero()};
    return set_of({{"ball", core, radius}});
  };
  const BoundingSet small = ball(0.5), large = ball(1);
  for (const double apart : {0.25, 1.0, 1.4375}) {
    const PosedSet a(small), b(large, {Eigen::Matrix3d::Identity(), Vec3(0, apart, 0)});
    const auto found = penetration(a, b);
    ASSERT_TRUE(found);
    EXPECT_LE(found->depth.lower, 1.5 - apart);
    EXPECT_GE(found->depth.upper, 1.5 - apart);
    EXPECT_NEAR(found->depth.lower, 1.5 - apart, 1e-9);
    EXPECT_NEAR(found->depth.upper, 1.5 - apart, 1e-9);
  }
  EXPECT_FALSE(
      penetration(PosedSet(small), PosedSet(large, {Eigen::Matrix3d::Identity(), Vec3(2, 0, 0)})));
}

TEST(Penetration, OfUnionsIsThatOfTheDeepestPairAtLeastAndPartsThemAtMost) {
  std::mt19937_64 random(8);
  int found_some = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<geom::ConvexBody> first, second;
    for (int k = 0; k < 3; ++k) {
      first.push_back({"", test::random_body(random, 0.8), 0});
      second.push_back({"", test::random_body(random, 0.8), k == 0 ? 0.05 : 0.0});
    }
    const BoundingSet a = set_of(first), b = set_of(second);
    const Transform pose = test::random_pose(random, 0.3);
    const PosedSet at_a(a), at_b(b, pose);
    const auto found = penetration(at_a, at_b);
    EXPECT_EQ(found.has_value(), find_collision(at_a, at_b).has_value()) << i;
    if (!found) continue;
    ++found_some;
    EXPECT_LE(found->depth.lower, found->depth.upper);
    Transform moved = pose;
    moved.translation += (found->depth.upper + 1e-9) * found->depth.direction;
    EXPECT_FALSE(find_collision(at_a, PosedSet(b, moved))) << i;
    // Nothing shorter than `lower` parts them.
    for (int k = 0; k < 20; ++k) {
      moved.translation = pose.translation +
                          0.999 * found->depth.lower * test::random_point(random, 1).normalized();
      if (found->depth.lower > 1e-6) {
        EXPECT_TRUE(find_collision(at_a, PosedSet(b, moved))) << i;
      }
    }
  }
  EXPECT_GT(found_some, 60);
}

/// A small body deep in a large one is deeper than their boxes overlap.
TEST(Penetration, OfVeryManyPairsTheDeepestIsFound) {
  std::vector<geom::ConvexBody> balls{{"", {{Vec3(10.5, 5, 5)}, {}}, 1},
                                      {"", {{Vec3(5, 5, 5)}, {}}, 0.1}},
      boxes{{"", cube(10), 0}};
  for (int i = 0; i < 300; ++i) {
    balls.push_back({"", {{Vec3(1000, 10 * i, 0)}, {}}, 0.1});
    boxes.push_back({"", {{Vec3(-1000, 10 * i, 0)}, {}}, 0.1});
  }
  const BoundingSet a = set_of(boxes), b = set_of(balls);
  const auto found = penetration(PosedSet(a), PosedSet(b)),
             reverse = penetration(PosedSet(b), PosedSet(a));
  ASSERT_TRUE(found && reverse);
  EXPECT_NEAR(found->depth.lower, 5.1, 1e-6);
  EXPECT_NEAR(reverse->depth.lower, 5.1, 1e-6);
}

}  // namespace
}  // namespace kaboum::collide
