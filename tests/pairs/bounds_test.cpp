// The bounds that proofs rest on, against points in configurations at random.

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>

#include <algorithm>

#include "gap.h"
#include "robots.h"

namespace kaboum::pairs::detail {
namespace {

/// Pose of b in the frame of a.
Transform between(const robot::Robot& robot, std::uint32_t a, std::uint32_t b,
                  const std::vector<double>& q) {
  const std::vector<Transform> at = judge::places(robot, {}, q);
  const Eigen::Matrix3d back = at[a].linear.transpose();
  return {back * at[b].linear, back * (at[b].translation - at[a].translation)};
}

std::vector<double> configuration(const robot::Robot& robot, const Chain& chain,
                                  const std::vector<double>& values) {
  std::vector<double> q(robot.variables.size(), 0);
  for (std::size_t v = 0; v < values.size(); ++v) q[chain.variables()[v]] = values[v];
  return q;
}

TEST(Chain, PlacesLinksWithinItsError) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const test::TestRobot of = test::random_robot(seed);
    Random random(seed);
    for (std::uint32_t a = 0; a < 6; ++a)
      for (std::uint32_t b = a + 1; b < 6; ++b) {
        const Chain chain(of.robot, a, b);
        std::vector<double> values;
        for (std::size_t v = 0; v < chain.variables().size(); ++v)
          values.push_back(random.between(chain.limits()->low[v], chain.limits()->high[v]));
        Chain::Placed placed;
        chain.place(values, placed);
        const Transform exact = between(of.robot, a, b, configuration(of.robot, chain, values));
        const Vec3 p = test::random_vector(random, 0.5);
        EXPECT_LE(((placed.b * p) - (exact * p)).norm(), chain.error(p.norm()));
      }
  }
}

TEST(HullTree, HoldsTheTrianglesOfEachCluster) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    // A rough ball: many corners, few of which are kept.
    std::vector<Vec3> points;
    for (int i = 0; i < 400; ++i)
      points.push_back(random.between(0.9, 1) * (test::random_vector(random, 1)).normalized());
    geom::Mesh mesh;
    mesh.vertices = points;
    for (std::uint32_t i = 0; i + 2 < points.size(); ++i)
      mesh.triangles.push_back({i, i + 1, i + 2});
    const HullTree tree(mesh);
    const Cluster& root = tree[0];
    EXPECT_LE(root.count, HullTree::kMostPoints);
    for (int i = 0; i < 200; ++i) {
      const Vec3 d = (test::random_vector(random, 1) + Vec3(1e-3, 0, 0)).normalized();
      double hull = -1e9, all = -1e9;
      for (std::uint32_t k = 0; k < root.count; ++k)
        hull = std::max(hull, d.dot(tree.point(root, k)));
      for (const Vec3& p : points) all = std::max(all, d.dot(p));
      EXPECT_GE(hull + root.radius, all - 1e-12);
    }
    for (const Vec3& p : points) EXPECT_LE((p - root.center).norm(), root.reach);
  }
}

TEST(Gaps, BoundTheDistanceAllOverTheBox) {
  std::size_t above = 0, by_second = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const test::TestRobot of = test::random_robot(seed);
    Random random(seed);
    for (std::uint32_t a = 0; a < 6; ++a)
      for (std::uint32_t b = a + 1; b < 6; ++b) {
        const Chain chain(of.robot, a, b);
        const HullTree ta(of.surfaces[a].outer), tb(of.surfaces[b].outer);
        const Gaps gaps(ta, tb, chain);
        const double width = std::pow(10, random.between(-3, 0));
        std::vector<double> middle, half;
        for (std::size_t v = 0; v < chain.variables().size(); ++v) {
          middle.push_back(random.between(chain.limits()->low[v], chain.limits()->high[v]));
          half.push_back(width * random.between(0, 1));
        }
        BoxMotion box(chain);
        box.set(middle, half);
        Vec3 direction = Vec3::Zero();
        const double lower = gaps.lower(ta[0], tb[0], box, direction, 1e9);
        const Vec3 center = box.placed().b * tb[0].center;
        const BoxMotion::Bound bound = box.bound(ta[0].center, ta[0].reach, center, tb[0].reach);
        by_second += bound.second < bound.first ? 1 : 0;
        above += lower > 0 ? 1 : 0;
        for (int i = 0; i < 30; ++i) {
          std::vector<double> values = middle;
          for (std::size_t v = 0; v < values.size(); ++v) {
            const std::size_t where = random.index(3);
            values[v] += half[v] * (where == 0 ? -1 : where == 1 ? 1 : random.between(-1, 1));
          }
          BoxMotion there(chain);
          there.set(values, std::vector<double>(values.size(), 0));
          const Gap gap = gaps.at_middle(ta[0], tb[0], there, Vec3::Zero(), 1e9);
          // The distance there is at most the one of these points.
          ASSERT_LE(lower, gap.upper + 1e-12) << seed << ": " << a << " " << b;
        }
      }
  }
  EXPECT_GT(above, 300U);
  EXPECT_GT(by_second, 300U);
}

TEST(Gaps, WhatTurnsInItsPlaneOrSlidesAcrossKeepsItsDistance) {
  for (const bool turns : {true, false})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Random random(seed);
      test::TestRobot of;
      of.robot.name = "flanges";
      of.robot.links = {{"a", {}, {}}, {"b", {}, {}}};
      robot::Joint joint;
      joint.name = "j";
      joint.type = turns ? robot::JointType::Revolute : robot::JointType::Prismatic;
      joint.axis = turns ? Vec3::UnitZ() : Vec3::UnitX();
      joint.origin = {test::random_turn(random), test::random_vector(random, 1)};
      of.robot.joints = {joint};
      of.robot.variables = {{"j", -3.0, 3.0}};
      // A millimetre between their faces, square to z.
      geom::Mesh a = test::box_mesh({-0.3, -0.2, -0.1}, {0.2, 0.4, 0});
      for (Vec3& v : a.vertices) v = joint.origin * v;
      const Chain chain(of.robot, 0, 1);
      const HullTree ta(a), tb(test::box_mesh({-0.2, -0.2, 0.001}, {0.5, 0.3, 0.1}));
      BoxMotion box(chain);
      box.set(std::vector{0.0}, std::vector{3.0});
      Vec3 direction = Vec3::Zero();
      const double lower = Gaps(ta, tb, chain).lower(ta[0], tb[0], box, direction, 0);
      EXPECT_GT(lower, 0.001 * (1 - 1e-6));
      EXPECT_LE(lower, 0.001);
    }
}

}  // namespace
}  // namespace kaboum::pairs::detail
