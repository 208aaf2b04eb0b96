// What links sweep, against their places in configurations at random.

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>

#include <algorithm>
#include <cmath>

#include "robots.h"
#include "search.h"
#include "swept.h"

namespace kaboum::pairs::detail {
namespace {

const std::function<bool()> kGoOn = [] { return false; };

/// What a link sweeps, seen from one that it hangs from.
std::optional<Swept> seen_from(const robot::Robot& robot, const Surface& surface,
                               std::uint32_t link, std::uint32_t from, std::size_t nodes) {
  std::optional<Swept> out(surface);
  for (; out && link != from; link = robot.joints[link - 1].parent)
    out = out->above(robot, robot.joints[link - 1], nodes, kGoOn);
  return out;
}

Transform inverse(const Transform& t) {
  return {t.linear.transpose(), -(t.linear.transpose() * t.translation)};
}

TEST(Swept, BoundsAreBelowTheDistanceFromWhereLinksAre) {
  std::size_t sets = 0, above = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    const test::TestRobot of = test::random_robot(seed);
    Random random(seed);
    for (const LinkSurface& s : of.surfaces) {
      const Surface surface(s.outer);
      for (std::uint32_t from = s.link; from > 0;) {
        from = of.robot.joints[from - 1].parent;
        const std::optional<Swept> swept = seen_from(of.robot, surface, s.link, from, 1'500);
        ASSERT_TRUE(swept);
        ++sets;
        for (int i = 0; i < 60; ++i) {
          const auto at = judge::places(of.robot, {}, test::random_configuration(of.robot, random));
          const Transform place = inverse(at[from]) * at[s.link];
          const Swept::Ball ball = swept->ball();
          for (const Vec3& v : s.outer.vertices) {
            const Vec3 p = place * v;
            EXPECT_LE((p - ball.center).norm(), ball.radius);
            for (const double away : {0.0, 0.03, 0.3, 3.0}) {
              const Vec3 d =
                  away * (test::random_vector(random, 1) + Vec3(1e-3, 0, 0)).normalized();
              const double bound = swept->distance(p + d);
              ASSERT_LE(bound, away + 1e-12) << seed << ": " << s.link << " from " << from;
              above += bound > 0.5 * away && away > 0 ? 1 : 0;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(sets, 80U);
  EXPECT_GT(above, 10'000U);  // and they are worth something
}

/// A box on a joint, of which the distance from points is known.
robot::Robot one_joint(robot::JointType type, double lower, double upper) {
  robot::Robot out;
  out.links = {{"a", {}, {}}, {"b", {}, {}}};
  robot::Joint joint;
  joint.name = "j";
  joint.type = type;
  joint.axis = type == robot::JointType::Prismatic ? Vec3::UnitX() : Vec3::UnitZ();
  out.joints = {joint};
  out.variables = {{"j", lower, upper}};
  return out;
}

// Axes next to -z are no special case: a joint rounded from a turn by half a circle has one.
TEST(Swept, AxesNextToTheOppositeOfTheGrids) {
  for (const double tilt : {0.0, 1e-8, 1e-6, 1.42e-6, 3.67e-6, 1e-5, 1e-4}) {
    robot::Robot robot = one_joint(robot::JointType::Revolute, -2, 2);
    robot.joints[0].axis = Vec3(0, tilt, -1).normalized();
    const Surface box(test::box_mesh({0.8, -0.1, 0.9}, {1, 0.1, 1.1}));
    const auto swept = Swept(box).above(robot, robot.joints[0], 3'000, kGoOn);
    ASSERT_TRUE(swept);
    const Swept::Ball ball = swept->ball();
    for (int i = 0; i <= 400; ++i) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(-2 + 0.01 * i, robot.joints[0].axis).toRotationMatrix();
      for (const Vec3& v : box.mesh().vertices) {
        EXPECT_LE((turn * v - ball.center).norm(), ball.radius + 1e-12) << tilt;
        for (const Vec3& d : {Vec3(0, 0, 0), Vec3(0, 0, 1e-3), Vec3(1e-3, 0, 0), Vec3(0, 1e-4, 0)})
          EXPECT_LE(swept->distance(turn * v + d), d.norm() + 1e-12) << tilt;
      }
    }
  }
}

// Limits that stand for none, or are far beyond all turns, sweep all of them.
TEST(Swept, LimitsThatAreHuge) {
  const Surface box(test::box_mesh({0.9, -0.1, -0.1}, {1, 0.1, 0.1}));
  for (const double limit : {4.0, 1e6, 1e16, 1e18, 1e19, 1e20, 1e100, 1e300}) {
    const robot::Robot robot = one_joint(robot::JointType::Revolute, -limit, limit);
    const auto turned = Swept(box).above(robot, robot.joints[0], 5'000, kGoOn);
    if (!turned) continue;
    for (int i = 0; i < 100; ++i)
      EXPECT_LE(turned->distance(0.95 * Vec3(std::cos(0.07 * i), std::sin(0.07 * i), 0)), 1e-12)
          << limit;
    const Surface other(test::box_mesh({-1, -0.1, -0.1}, {-0.9, 0.1, 0.1}));
    EXPECT_EQ(apart_by_sweeping(robot, {0, 1}, {&other, &box}, {{0, 1}}, 50'000, kGoOn).front(), 0)
        << limit;
  }
}

TEST(Swept, BoundsAreNearKnownDistances) {
  const Surface box(test::box_mesh({0.8, -0.1, -0.1}, {1, 0.1, 0.1}));
  const auto turned = [&](double angle, double radius) {
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), 0);
  };
  // Corners of the box are 0.1 rad from its middle, and farther out than its face.
  const double outermost = std::hypot(1, 0.1);
  const auto quarter =
      Swept(box).above(one_joint(robot::JointType::Revolute, 0, 1.5),
                       one_joint(robot::JointType::Revolute, 0, 1.5).joints[0], 20'000, kGoOn);
  for (const double d : {0.1, 0.2, 1.0}) {
    EXPECT_GT(quarter->distance(turned(0.75, outermost + d)), 0.95 * d - 0.01);
    EXPECT_LT(quarter->distance(turned(0.75, outermost + d)), d + 1e-12);
    // Of points outside of the grid less is known.
    EXPECT_GT(quarter->distance(Vec3(0.9, -0.1 - d, 0)), (d < 0.5 ? 0.95 : 0.8) * d - 0.01);
    EXPECT_LT(quarter->distance(Vec3(0.9, -0.1 - d, 0)), d + 1e-12);
    EXPECT_GT(quarter->distance(Vec3(0.9, 0, 0.1 + d)), 0.95 * d - 0.01);
  }
  const robot::Robot slide = one_joint(robot::JointType::Prismatic, -0.5, 0.25);
  const auto slid = Swept(box).above(slide, slide.joints[0], 20'000, kGoOn);
  for (const double d : {0.1, 0.2, 1.0}) {
    EXPECT_GT(slid->distance(Vec3(1.25 + d, 0, 0)), 0.95 * d - 0.01);
    EXPECT_LT(slid->distance(Vec3(1.25 + d, 0, 0)), d + 1e-12);
    EXPECT_GT(slid->distance(Vec3(0.3 - d, 0, 0)), 0.95 * d - 0.01);
    EXPECT_LT(slid->distance(Vec3(0.3 - d, 0, 0)), d + 1e-12);
  }
}

TEST(Swept, WhatIsSaidToBeApartIsNoNearerInAnyConfiguration) {
  std::size_t apart = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const test::TestRobot of = test::random_robot(seed);
    std::vector<std::unique_ptr<Surface>> made;
    std::vector<const Surface*> surfaces;
    std::vector<std::uint32_t> links;
    std::vector<PairOfSurfaces> pairs;
    for (const LinkSurface& s : of.surfaces) {
      surfaces.push_back(made.emplace_back(std::make_unique<Surface>(s.outer)).get());
      links.push_back(s.link);
      for (std::size_t a = 0; a + 1 < links.size(); ++a) pairs.emplace_back(a, links.size() - 1);
    }
    const std::vector<double> found =
        apart_by_sweeping(of.robot, links, surfaces, pairs, 4'000, kGoOn);
    ASSERT_EQ(found.size(), pairs.size());
    Random random(seed);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (found[i] == 0) continue;
      ++apart;
      const auto [a, b] = pairs[i];
      const Chain chain(of.robot, links[a], links[b]);
      const Contact contact(*surfaces[a], *surfaces[b], chain);
      BoxMotion motion(chain);
      for (int k = 0; k < 100; ++k) {
        const std::vector<double> q = test::random_configuration(of.robot, random);
        std::vector<double> values;
        for (const std::uint32_t v : chain.variables()) values.push_back(q[v]);
        motion.set(values, std::vector<double>(values.size(), 0));
        EXPECT_GE(contact.nearest(motion, 0, 100'000).upper, found[i]) << seed;
      }
    }
  }
  EXPECT_GT(apart, 40U);
}

TEST(Swept, JointsThatSlideWithoutLimitsSweepWhatIsNotKnown) {
  robot::Robot robot = one_joint(robot::JointType::Prismatic, 0, 1);
  const Surface box(test::box_mesh({0.8, -0.1, -0.1}, {1, 0.1, 0.1}));
  robot.variables[0].upper = {};
  EXPECT_FALSE(Swept(box).above(robot, robot.joints[0], 1'000, kGoOn));
  robot.joints[0].type = robot::JointType::Revolute;
  robot.joints[0].axis = Vec3::UnitZ();
  const auto turn = Swept(box).above(robot, robot.joints[0], 20'000, kGoOn);
  ASSERT_TRUE(turn);
  EXPECT_LT(turn->distance(Vec3(-0.9, 0, 0)), 1e-3);
  EXPECT_GT(turn->distance(Vec3(-0.5, 0, 0)), 0.25);
}

}  // namespace
}  // namespace kaboum::pairs::detail
