// How things stand that are pushed: their bases by drawn points, where they may go by what the
// constraints of a push allow, and where a contact is too narrow.

#include <gtest/gtest.h>
#include <kaboum/base/random.h>
#include <kaboum/geom/convex_hull.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "push_contact.h"
#include "standing.h"
#include "two_arms.h"

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;
using manipulation::PushedObject;
using Kind = world::Feature::Kind;

constexpr double kGap = 1e-3;  // between things and what they stand on [m]

/// A frustum about the z axis: half sides at both ends.
geom::ConvexBody frustum(double low_half, double high_half, double low, double high) {
  std::vector<Vec3> points;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      points.emplace_back(x * low_half, y * low_half, low);
      points.emplace_back(x * high_half, y * high_half, high);
    }
  return {"", *geom::convex_hull(points)};
}

world::Object thing(std::vector<geom::ConvexBody> bodies, double epsilon) {
  return {"thing", {}, {std::move(bodies), collide::Direction::Outer, epsilon}, {}, {}, {}};
}

/// A table of 2 m by 2 m, its top at 0.
world::Object table(double epsilon) {
  world::Object out = thing({frustum(1, 1, -1, 0)}, epsilon);
  out.name = "table";
  return out;
}

/// A thing that stands at the origin, its centre of mass beside the middle.
std::string refusal_of(world::Object object, double support_epsilon, double mass, double turn = 0) {
  object.features = {{"bottom", Kind::Point, {0, 0, 0}, {}},
                     {"mass", Kind::Point, {mass, 0, 0.02}, {}}};
  const world::Object below = table(support_epsilon);
  const Transform at{Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix(), {0, 0, kGap}};
  return PushedObject(object, at, below, {}, kGap).refusal();
}

void expect_too_near(const std::string& refusal) {
  EXPECT_NE(refusal.find("too near the edge of its base"), std::string::npos) << refusal;
}

TEST(PushStand, TheCenterIsAboveTheFootAndNotAboveWhatFlaresOverIt) {
  // Half a foot of 15.6 mm under a cup of 62.5 mm, and a support of which little is known.
  for (const double epsilon : {0.0, 0.001, 0.007}) {
    const auto cup = [&] { return thing({frustum(1. / 64, 1. / 16, 0, 1. / 128)}, 0); };
    EXPECT_EQ(refusal_of(cup(), epsilon, 0), "") << epsilon;
    EXPECT_EQ(refusal_of(cup(), epsilon, 0.005), "") << epsilon;
    // What is within 0.1 mm of the lowest counts as the foot: that is 0.6 mm more to each side.
    for (const double mass : {0.0065, 0.01, 0.045})
      expect_too_near(refusal_of(cup(), epsilon, mass));
  }
}

TEST(PushStand, TheSolidsBaseMayEndBeforeThatOfItsSet) {
  // The solid's base may end 20 mm before the set's. Leaning by 0.002 rad takes less than 1 mm.
  const auto block = [] { return thing({frustum(1. / 16, 1. / 16, 0, 1. / 8)}, 0.02); };
  constexpr double kMost = 1. / 16 - 0.02 - 0.01;
  EXPECT_EQ(refusal_of(block(), 0, kMost - 0.001), "");
  for (const double mass : {kMost, 0.04, 0.05}) expect_too_near(refusal_of(block(), 0, mass));
}

TEST(PushStand, AFootTooNarrowForSlotsIsRefusedHoweverItIsTurned) {
  const std::vector<Vec3> plate = box_at({0.2, 0.001, 0.1}, {0, 0, 0.05}).vertices,
                          bar = box_at({0.2, 0.05, 0.1}, {0, 0, 0.05}).vertices;
  for (const double turn : {0.0, 0.3, std::numbers::pi / 4, 2.0}) {
    EXPECT_NE(refusal_of(thing({{"", *geom::convex_hull(plate)}}, 0), 0.01, 0, turn)
                  .find("too narrow to be pushed on table"),
              std::string::npos)
        << turn;
    EXPECT_EQ(refusal_of(thing({{"", *geom::convex_hull(bar)}}, 0), 0.01, 0, turn), "") << turn;
    // The solid may be narrower than its set, by 6 mm on both sides.
    EXPECT_NE(refusal_of(thing({{"", *geom::convex_hull(bar)}}, 0.006), 0.01, 0, turn), "") << turn;
  }
  // What flares above the foot bridges nothing: 40 mm is four times the support's ε.
  EXPECT_EQ(refusal_of(thing({frustum(0.021, 0.1, 0, 0.01)}, 0), 0.01, 0), "");
  EXPECT_NE(refusal_of(thing({frustum(0.019, 0.1, 0, 0.01)}, 0), 0.01, 0).find("too narrow"),
            std::string::npos);
}

TEST(PushStand, WhatReachesBelowItsBottomDoesNotStandOnIt) {
  // A peg under the base; all that the set may reach below the solid is its own ε.
  const auto block = [](double epsilon) {
    return thing({frustum(0.06, 0.06, 0, 0.1), frustum(0.002, 0.002, -0.005, 0.05)}, epsilon);
  };
  EXPECT_NE(refusal_of(block(0.001), 0.01, 0).find("does not stand on its point 'bottom'"),
            std::string::npos);
  EXPECT_EQ(refusal_of(block(0.006), 0.01, 0), "");
}

/// A convex polytope, by drawn points.
geom::ConvexBody drawn_body(Random& random) {
  std::vector<Vec3> points;
  points.reserve(12);
  for (int i = 0; i < 12; ++i)
    points.emplace_back(random.between(-1, 1), random.between(-1, 1), random.between(0, 1));
  return {"", *geom::convex_hull(points)};
}

/// A point of a body's core: a mixture of its vertices.
Vec3 drawn_point(const geom::Mesh& core, Random& random) {
  Vec3 sum = Vec3::Zero();
  double all = 0;
  for (const Vec3& v : core.vertices) {
    const double share = std::pow(random.between(0, 1), 8);
    sum += share * v;
    all += share;
  }
  return sum / all;
}

/// The least height of a body on the vertical line through a point; 10: the line misses it. Of a
/// rounded segment: of the segment, lowered by the radius.
double beginning(const geom::ConvexBody& body, const Vec3& p) {
  constexpr double kMisses = 10, kNear = 1e-9;
  if (body.core.triangles.empty()) {
    const Vec3 a = body.core.vertices[0], b = body.core.vertices[1] - a;
    const double share =
        std::clamp((p - a).head<2>().dot(b.head<2>()) / b.head<2>().squaredNorm(), 0.0, 1.0);
    const Vec3 nearest = a + share * b;
    return (nearest - p).head<2>().norm() <= kNear ? nearest.z() - body.radius : kMisses;
  }
  double low = -kMisses, high = kMisses;
  for (const auto& t : body.core.triangles) {
    const Vec3 &a = body.core.vertices[t[0]], &b = body.core.vertices[t[1]],
               &c = body.core.vertices[t[2]];
    const Vec3 n = (b - a).cross(c - a).normalized();
    const double above = n.dot(Vec3(p.x(), p.y(), 0) - a);  // + n.z() * height <= 0
    if (std::abs(n.z()) < kNear) {
      if (above > kNear) return kMisses;
    } else if (n.z() > 0) {
      high = std::min(high, -above / n.z());
    } else {
      low = std::max(low, -above / n.z());
    }
  }
  return low <= high + kNear ? low : kMisses;
}

TEST(PushStand, BasesHoldWhatIsLowAndFeetNoMore) {
  Random random(11);
  int low = 0, cut = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<geom::ConvexBody> bodies = {drawn_body(random), drawn_body(random)};
    // A rounded segment as well.
    geom::ConvexBody round_one;
    round_one.radius = 0.25;
    round_one.core.vertices = {{random.between(-1, 1), random.between(-1, 1), 0.3},
                               {random.between(-1, 1), random.between(-1, 1), 0.9}};
    bodies.push_back(round_one);
    const world::Object object = thing(bodies, 0.01);
    const double close = random.between(0.05, 0.5);
    const auto turned = Eigen::AngleAxisd(random.between(0, 3), Vec3::UnitZ()).toRotationMatrix();
    const Vec3 point(0.1, -0.2, 0);
    std::vector<geom::Vec2> seen;
    for (const Vec3& corner : manipulation::base_of(object, turned, point, close))
      seen.emplace_back(corner.head<2>());
    const geom::Polygon2 base = geom::convex_hull(seen);
    for (const geom::ConvexBody& body : bodies)
      for (int i = 0; i < 400; ++i) {
        Vec3 p = drawn_point(body.core, random);
        const Vec3 off(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
        p += body.radius * off.normalized();
        if (p.z() > close) continue;
        ++low;
        EXPECT_TRUE(geom::holds(base, (turned * (p - point)).head<2>(), -1e-8)) << p.transpose();
      }
    // Below every corner of the foot a body begins, no higher than it may.
    for (const geom::Vec2& corner :
         manipulation::foot_of(object, turned, point + Vec3(0, 0, close))) {
      const Vec3 p = turned.transpose() * Vec3(corner.x(), corner.y(), 0) + point;
      double least = 10;
      for (const geom::ConvexBody& body : bodies) least = std::min(least, beginning(body, p));
      EXPECT_LE(least, close + manipulation::kFlat + 1e-9) << p.transpose();
      cut += std::abs(least - close - manipulation::kFlat) < 1e-9 ? 1 : 0;
    }
  }
  EXPECT_GT(low, 1000);
  EXPECT_GT(cut, 100);
}

/// Wherever the constraints of a push allow the object to be, its base is clear of the edges.
TEST(PushStand, AllThatTheConstraintsAllowIsOnTheTable) {
  constexpr double kHalf = 0.025, kEpsilon = 1e-4;
  world::Object object = thing({frustum(kHalf, kHalf, 0, 0.1)}, kEpsilon);
  object.features = {{"bottom", Kind::Point, {0, 0, 0}, {}}};
  const world::Object below = table(kEpsilon);
  const Transform at{Eigen::Matrix3d::Identity(), {0, 0, kGap}};
  const PushedObject pushed(object, at, below, {}, kGap);
  ASSERT_EQ(pushed.refusal(), "");
  for (const double angle : {0.0, 0.2, std::numbers::pi / 4, 1.2}) {
    const Vec3 way(std::cos(angle), std::sin(angle), 0), left = Vec3::UnitZ().cross(way);
    const double length = pushed.farthest(way);
    world::Attachment held;
    const auto kept = manipulation::push_constraints(held, at, at.translation, way, length);
    ASSERT_EQ(kept.size(), 4U);
    const double off = kept[0].within, ball = kept[1].within, turn = kept[3].within_angle;
    double nearest = 1;  // of a corner to an edge
    constexpr int kSteps = 200;
    for (int i = -kSteps; i <= kSteps; ++i) {
      const double aside = off * i / kSteps,
                   along = 0.5 * length + std::sqrt(ball * ball - aside * aside);
      for (const double turned : {-turn, turn})
        for (const double x : {-kHalf, kHalf})
          for (const double y : {-kHalf, kHalf}) {
            const Vec3 corner = along * way + aside * left +
                                Eigen::AngleAxisd(turned, Vec3::UnitZ()) * Vec3(x, y, 0);
            nearest = std::min({nearest, 1 - corner.x(), 1 - corner.y()});
          }
    }
    EXPECT_GE(nearest, kEpsilon) << angle;
    EXPECT_LE(nearest, kEpsilon + 5e-4) << angle << ": farther than it has to be";
  }
}

TEST(PushStand, ContactReachesToBothSidesByMoreThanTheSetsMayAdd) {
  TwoArms arms;
  const world::RobotModel& robot = arms.world.robots[TwoArms::kLeft];
  const world::LinkFeature front{arms.hand, {"push", Kind::Plane, {0.015, 0, 0.145}, {1, 0, 0}}};
  for (const double epsilon : {TwoArms::kEpsilon, 0.004}) {
    const world::Object block = thing({{"", box_at({0.05, 0.05, 0.16}, Vec3::Zero())}}, epsilon);
    const auto touches = [&](double aside) {
      const world::Feature side{"push", Kind::Plane, {-0.025, aside, -0.04}, {-1, 0, 0}};
      const Transform at{Eigen::Matrix3d::Identity(), {0.5, 0.3, 0.08}};
      return manipulation::push_contact(robot, front, block, at, side, Vec3::UnitX(),
                                        at.translation, 0, kGap)
          .has_value();
    };
    // The hand is 15 mm wide to each side of its plane's point.
    const double most = 0.015 - 0.003 - epsilon - TwoArms::kEpsilon;
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_TRUE(touches(sign * (most - 1e-6))) << epsilon;
      EXPECT_FALSE(touches(sign * (most + 1e-6))) << epsilon;
    }
  }
}

TEST(PushStand, WhatCountsAsLevelHasUprightPlanes) {
  for (const double roll : {std::numbers::pi / 2, 1.5708, 1.57075, 1.5702, 1.58}) {
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(roll, Vec3::UnitX()).toRotationMatrix();
    const world::Feature side{"push", Kind::Plane, {0, 0, -0.05}, {0, 0, -1}};
    const Transform at{turned, {0, 0, 0.1}};
    const bool level = std::abs(roll - std::numbers::pi / 2) < 1e-4;
    const auto way = manipulation::push_direction(at, side, at.translation);
    EXPECT_EQ(way.has_value(), level) << roll;
    EXPECT_TRUE(!way || std::abs(way->z()) == 0) << roll;
  }
}

}  // namespace
}  // namespace kaboum::test
