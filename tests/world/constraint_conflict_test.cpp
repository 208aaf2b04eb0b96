// Contradictions are proved: never of constraints that a known pose meets, and always of such as
// contradict each other by their angles or by the distances of their points.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/world/constraint_conflict.h>
#include <kaboum/world/features.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "refused.h"

namespace kaboum::world {
namespace {

using kinematics::Relation;
using Kind = Feature::Kind;
using To = FixedFeature::To;

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::size_t index(std::size_t count) { return random_() % count; }
  Vec3 point() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  Vec3 direction() {
    return Vec3(normal_(random_), normal_(random_), normal_(random_)).normalized();
  }
  Transform pose() {
    return {Eigen::AngleAxisd(between(-std::numbers::pi, std::numbers::pi), direction())
                .toRotationMatrix(),
            3 * point()};
  }
  Feature feature(Kind kind) {
    Feature out{"f", kind, point()};
    if (kind != Kind::Point) out.direction = direction();
    if (kind != Kind::Surface) return out;
    out.radius = between(0.1, 1);
    if (index(2) == 0) return out;
    // A triangle round the point.
    const Vec3 x = out.direction.unitOrthogonal(), y = out.direction.cross(x);
    for (const double angle : {0.3, 2.4, 4.4})
      out.outline.push_back(out.point + out.radius * (std::cos(angle) * x + std::sin(angle) * y));
    out.radius = 0;
    return out;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A constraint of two objects that they meet, just about, where the second one has this pose in
/// the first one's frame.
/// @param kinds_of_features: as many of the first ones
ToleratedConstraint met_at(const Transform& pose, Draws& draws, std::size_t kinds_of_features = 4) {
  for (;;) {
    ToleratedConstraint c;
    c.relation = static_cast<Relation>(draws.index(5));
    const Kind kinds[2] = {static_cast<Kind>(draws.index(kinds_of_features)),
                           static_cast<Kind>(draws.index(kinds_of_features))};
    c.first = {To::Object, 0, 0, draws.feature(kinds[0])};
    c.second = {To::Object, 1, 0, draws.feature(kinds[1])};
    const double slack = draws.index(2) == 0 ? 1e-6 : 0.05;
    try {
      require_valid(kinematics_constraint(c));
    } catch (const Error&) {
      continue;
    }
    // What is measured there is asked for; what is to be 0 is let be as large as it is.
    const Feature a = c.first.feature, b = moved(c.second.feature, pose);
    const bool mixed = (a.kind == Kind::Line) != (b.kind == Kind::Line);
    if (c.relation == Relation::Angle) {
      const double angle = angle_between(a.direction, b.direction);
      c.value = mixed ? std::numbers::pi / 2 - angle : angle;
      c.within_angle = slack;
    } else {
      const Vec3 way = a.point - b.point;
      const Feature& larger = a.kind > b.kind ? a : b;
      const double apart = larger.kind == Kind::Point  ? way.norm()
                           : larger.kind == Kind::Line ? way.cross(larger.direction).norm()
                                                       : std::abs(way.dot(larger.direction));
      c.within = way.norm() + slack;
      if (c.relation == Relation::Distance && larger.kind != Kind::Surface) {
        c.value = apart;
        c.within = slack;
      }
      c.within_angle = std::numbers::pi / 2 - 0.01;
      if (draws.index(2) == 0) {
        const double angle = angle_between(a.direction, b.direction);
        const double skew = std::min(angle, std::numbers::pi - angle);
        const bool aligned = (c.relation != Relation::Perpendicular) != mixed;
        c.within_angle = (aligned ? skew : std::numbers::pi / 2 - skew) + slack;
      }
    }
    if (is_met(c, {}, pose)) return c;
  }
}

TEST(Contradictions, AreNeverFoundWhereAPoseMeetsAll) {
  Draws draws(1);
  std::size_t several = 0;
  for (int round = 0; round < 600; ++round) {
    const Transform pose = draws.pose();
    std::vector<ToleratedConstraint> all;
    for (std::size_t n = 2 + draws.index(4); n > 0; --n) {
      all.push_back(met_at(pose, draws));
      if (draws.index(2) == 0) std::swap(all.back().first, all.back().second);
    }
    several += all.size() > 3 ? 1 : 0;
    EXPECT_FALSE(find_contradiction(all)) << "round " << round;
  }
  EXPECT_GT(several, 100U);
  // Of points alone, which are to be away from each other as well as near.
  for (int round = 0; round < 300; ++round) {
    const Transform pose = draws.pose();
    std::vector<ToleratedConstraint> all;
    for (std::size_t n = 2 + draws.index(2); n > 0; --n) all.push_back(met_at(pose, draws, 1));
    EXPECT_FALSE(find_contradiction(all)) << "round " << round << " of points";
  }
  // The rotation is given by two angles: what is said of the place is all that may contradict.
  for (int round = 0; round < 600; ++round) {
    const Transform pose = draws.pose();
    std::vector<ToleratedConstraint> all;
    while (all.size() < 2) {
      const Feature axis = draws.feature(Kind::Line);
      Feature other = axis;
      other.direction = pose.linear.transpose() * axis.direction;
      all.push_back(
          {Relation::Angle, {To::Object, 0, 0, axis}, {To::Object, 1, 0, other}, 0, 0, 0.02});
    }
    while (all.size() < 4) {
      ToleratedConstraint c = met_at(pose, draws, round % 2 == 0 ? 4 : 2);
      if (c.relation != Relation::Distance && c.relation != Relation::Coincident) continue;
      if (c.first.feature.kind != Kind::Point && c.second.feature.kind != Kind::Point) continue;
      all.push_back(c);
    }
    EXPECT_FALSE(find_contradiction(all)) << "round " << round << " of a known rotation";
  }
}

FixedFeature of(std::size_t object, Feature feature) {
  return {To::Object, object, 0, std::move(feature)};
}
Feature point(const Vec3& at) { return {"p", Kind::Point, at}; }
Feature line(const Vec3& direction, const Vec3& at = Vec3::Zero()) {
  return {"l", Kind::Line, at, direction.normalized()};
}
Feature plane(const Vec3& normal, const Vec3& at = Vec3::Zero()) {
  return {"e", Kind::Plane, at, normal.normalized()};
}
Feature disc(const Vec3& normal, const Vec3& at, double radius) {
  return {"s", Kind::Surface, at, normal.normalized(), {}, radius};
}

TEST(Contradictions, AreFoundInAnglesAndInDistances) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const auto c = [](Relation relation, const Feature& a, const Feature& b, double value = 0) {
    return ToleratedConstraint{relation, of(0, a), of(1, b), value};
  };
  using Set = std::vector<ToleratedConstraint>;
  const std::vector<Set> sets{
      {c(Relation::Parallel, line(z), line(z)), c(Relation::Perpendicular, line(z), line(z))},
      {c(Relation::Angle, line(z), line(z), 0), c(Relation::Angle, line(z), line(z), 0.5)},
      {c(Relation::Angle, line(z), line(z), 0), c(Relation::Angle, line(x), line(x), 0),
       c(Relation::Angle, line(y), line(y), std::numbers::pi)},
      {c(Relation::Parallel, line(z), plane(x)), c(Relation::Parallel, line(y), plane(x)),
       c(Relation::Parallel, line(x), plane(x))},
      {c(Relation::Coincident, point({0, 0, 0}), point({0, 0, 0})),
       c(Relation::Coincident, point({0, 0, 1}), point({0, 0, 1.01}))},
      {c(Relation::Coincident, point({0, 0, 0}), plane(z)),
       c(Relation::Distance, point({0, 0, 0}), plane(z), 0.01)},
      {c(Relation::Coincident, point({0, 0, 0}), plane(z)),
       c(Relation::Coincident, point({0, 0, 0}), plane(z, {0, 0, 0.1}))},
      {c(Relation::Coincident, point({0, 0, 0}), line(x)),
       c(Relation::Coincident, point({0, 0, 0}), line(y, {0, 0, 0.1}))},
      {c(Relation::Coincident, point({0, 0, 0}), disc(z, {0, 0, 0}, 0.1)),
       c(Relation::Coincident, point({1, 0, 0}), point({0, 0, 0}))},
      {c(Relation::Coincident, disc(z, {0, 0, 0}, 0.1), point({0, 0, 0})),
       c(Relation::Distance, disc(z, {0, 0, 0}, 0.1), point({0, 0, 0}), 0.05)},
      // Upright, and the rim over the middle of the table as the bottom is.
      {c(Relation::Angle, line(z), line(z), 0), c(Relation::Coincident, point({0, 0, 0}), line(z)),
       c(Relation::Coincident, point({0.1, 0, 0.1}), line(z))},
      {c(Relation::Distance, point({0, 0, 0}), point({0, 0, 0}), 0.1),
       c(Relation::Distance, point({0, 0, 0}), point({0, 0, 0}), 0.5)},
  };
  for (std::size_t i = 0; i < sets.size(); ++i) {
    auto set = sets[i];
    const auto found = find_contradiction(set);
    ASSERT_TRUE(found) << i;
    EXPECT_EQ(found->size(), set.size()) << i << ": each of them is needed";
    std::reverse(set.begin(), set.end());
    EXPECT_TRUE(find_contradiction(set)) << i << ", the other way round";
    std::reverse(set.begin(), set.end());
    // What is not in the way is not named, in whichever order.
    set.insert(set.begin(), c(Relation::Angle, line(x), line(x), 0.3));
    if (i == 0) {
      EXPECT_EQ(*find_contradiction(set), (std::vector<std::size_t>{1, 2}));
    }
    // Between other things there is none.
    set = sets[i];
    set.front().first.index = 2;
    EXPECT_FALSE(find_contradiction(set)) << i;
    // Where tolerances make up for it there is none.
    set = sets[i];
    for (ToleratedConstraint& one : set) {
      one.within = 2;
      one.within_angle = 3;
    }
    EXPECT_FALSE(find_contradiction(set)) << i;
  }
}

TEST(Contradictions, TolerancesDecide) {
  // A bar of 1 between points that are 1.1 apart: 0.05 at each end is what is missing.
  std::vector<ToleratedConstraint> set{
      {Relation::Coincident, of(0, point({0, 0, 0})), of(1, point({0, 0, 0}))},
      {Relation::Coincident, of(0, point({0, 0, 1})), of(1, point({0, 0, 1.1}))}};
  for (ToleratedConstraint& c : set) c.within = 0.0499;
  EXPECT_TRUE(find_contradiction(set));
  for (ToleratedConstraint& c : set) c.within = 0.0501;
  EXPECT_FALSE(find_contradiction(set));
  // Two lines at 0.3 rad, each to be along the same one.
  set = {{Relation::Angle, of(0, line(Vec3::UnitZ())), of(1, line(Vec3::UnitZ()))},
         {Relation::Angle, of(0, line(Vec3::UnitZ())),
          of(1, line({std::sin(0.3), 0, std::cos(0.3)}))}};
  for (ToleratedConstraint& c : set) c.within_angle = 0.148;
  EXPECT_TRUE(find_contradiction(set));
  for (ToleratedConstraint& c : set) c.within_angle = 0.151;
  EXPECT_FALSE(find_contradiction(set));
}

/// A column that does not move, on it a slide along z from −0.5 to 0.25 m times −2 and 0.1, and on
/// that an arm of 1 m that turns about x, as far as a mimic joint has it.
RobotModel sliding_arm() {
  RobotModel out;
  out.name = "lift";
  robot::Robot& r = out.kinematics;
  for (const char* name : {"root", "column", "slide", "arm"}) r.links.push_back({name, {}, {}});
  const auto joint = [&](robot::JointType type, std::uint32_t parent, const Vec3& at,
                         const Vec3& axis) {
    r.joints.push_back({"j", type, parent, {Eigen::Matrix3d::Identity(), at}, axis, 0, 1, 0});
  };
  joint(robot::JointType::Fixed, 0, {0, 0, 1}, Vec3::UnitZ());
  joint(robot::JointType::Prismatic, 1, {0, 0, 0}, Vec3::UnitZ());
  r.joints.back().multiplier = -2;
  r.joints.back().offset = 0.1;
  joint(robot::JointType::Revolute, 2, {0, 0, 0}, Vec3::UnitX());
  r.variables.push_back({"j", -0.5, 0.25});
  out.base.translation = {10, 0, 0};
  return out;
}

TEST(Reach, IsThatOfTheChainWhateverItsJointsAre) {
  RobotModel lift = sliding_arm();
  EXPECT_NEAR(longest_reach(lift, 0, {0, 0, 2}), 2, 1e-6);
  EXPECT_NEAR(longest_reach(lift, 1, {0, 0, 0}), 1, 1e-6);
  const double most = 1 + 2 * 0.5 + 0.1 + 1;
  EXPECT_NEAR(longest_reach(lift, 3, {0, 1, 0}), most, 1e-6);
  const auto beyond = [&](Relation relation, Feature rest, double value) {
    rest.point += lift.base.translation;
    for (Vec3& corner : rest.outline) corner += lift.base.translation;
    return is_beyond_reach(
        lift, {relation, {To::Link, 0, 3, point({0, 1, 0})}, {To::World, 0, 0, rest}, value, 0.01});
  };
  for (const double off : {-0.001, 0.001}) {
    const double d = most + 0.01 + off;
    EXPECT_EQ(beyond(Relation::Coincident, point({0, 0, d}), 0), off > 0);
    EXPECT_EQ(beyond(Relation::Coincident, line(Vec3::UnitX(), {5, d, 0}), 0), off > 0);
    EXPECT_EQ(beyond(Relation::Coincident, plane(Vec3::UnitY(), {7, -d, 3}), 0), off > 0);
    EXPECT_EQ(beyond(Relation::Coincident, disc(Vec3::UnitX(), {0, 0, d + 0.2}, 0.2), 0), off > 0);
    EXPECT_EQ(beyond(Relation::Distance, point({0, 0, d + 2}), 2), off > 0);
    EXPECT_EQ(beyond(Relation::Distance, point({0, 0, 1}), d + 1), off > 0) << "so far away";
    EXPECT_FALSE(beyond(Relation::Parallel, line(Vec3::UnitX(), {0, d, 0}), 0));
  }
  lift.kinematics.variables[0].upper.reset();
  EXPECT_FALSE(beyond(Relation::Coincident, point({0, 0, 1e6}), 0)) << "it slides without end";
}

class ConstraintScene : public ::testing::Test {
 protected:
  void expect_refused(const std::string& all, const std::vector<std::string>& words) const {
    test::expect_refused(files_, scene(all), words);
  }
  [[nodiscard]] std::string scene(const std::string& all, const std::string& more = "",
                                  const std::string& features = "") const {
    return files_.scene(
        R"("objects": [{"name": "box", "outer": )" + files_.ref("box.glb") + R"(, "features": [
          {"name": "lid", "surface": {"outline": [[0, 0, 0.5], [0.4, 0, 0.5], [0.4, 0.3, 0.5]]}},
          {"name": "spot", "surface": {"point": [0, 0, 0.5], "normal": [0, 0, 3], "radius": 0.1}})" +
            features + R"(]}], "constraints": [{"name": "c", "all": [)" + all + "]" + more + "}]",
        R"("tools": [{"name": "flange", "link": "l3", "position": [1, 0, 0]}])");
  }
  test::SceneFiles files_;
};

TEST_F(ConstraintScene, SurfacesAndPreferencesAreRead) {
  const World world = files_.world(scene(
      R"({"relation": "coincident", "first": "arm/flange.origin", "second": "box/lid", "within": 0.01})",
      R"(, "prefer": [{"relation": "coincident", "first": "arm/flange.origin", "second": "box/spot"}])"));
  const ConstraintSet& set = world.constraint_set("c");
  ASSERT_EQ(set.constraints.size(), 1U);
  ASSERT_EQ(set.preferred.size(), 1U);
  const Feature& lid = set.constraints[0].second.feature;
  EXPECT_EQ(lid.kind, Kind::Surface);
  EXPECT_EQ(lid.outline.size(), 3U);
  EXPECT_LT((lid.direction - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_EQ(set.preferred[0].second.feature.radius, 0.1);
  EXPECT_EQ(set.preferred[0].second.feature.direction, Vec3::UnitZ());
}

TEST_F(ConstraintScene, WhatNothingMeetsIsRefused) {
  const std::string parallel =
      R"({"relation": "parallel", "first": "arm/flange.x", "second": "box.x"})";
  expect_refused(
      parallel + R"(, {"relation": "perpendicular", "first": "box.x", "second": "arm/flange.x"})",
      {"contradict each other", "parallel 'arm/flange.x' 'box.x'",
       "perpendicular 'box.x' 'arm/flange.x'", "widen its tolerance"});
  expect_refused(R"({"relation": "parallel", "first": "box.x", "second": "box.y"})",
                 {"fixed to the same thing"});
  // Three lengths of 1, and the first joint 0.1 above the base.
  const auto at = [](const std::string& value) {
    return R"({"relation": "distance", "first": "arm/flange.origin", "second": "world.origin", "within": 0.01, "value": )" +
           value + "}";
  };
  expect_refused(at("3.12"), {"'arm' does not reach so far"});
  // What is fixed to the root has a place, which may be the one that is asked for.
  EXPECT_NO_THROW((void)files_.world(
      scene(R"({"relation": "coincident", "first": "arm.origin", "second": "world.xy"})")));
  expect_refused(
      R"({"relation": "coincident", "first": "arm.origin", "second": "world.xy"}], "prefer": [
      {"relation": "distance", "first": "arm.origin", "second": "world.xy", "value": 0.5})",
      {"what is preferred is never met: these constraints contradict each other"});
  expect_refused(R"({"relation": "parallel", "first": "arm.x", "second": "world.x"}], "prefer": [
      {"relation": "coincident", "first": "arm/flange.origin", "second": "box/lid"}, {
       "relation": "distance", "first": "world.origin", "second": "arm/flange.origin", "value": 7})",
                 {"does not reach so far"});
  EXPECT_NO_THROW((void)files_.world(scene(at("3.1"))));
}

TEST_F(ConstraintScene, EmptySurfacesAreRefused) {
  const std::string one =
      R"({"relation": "coincident", "first": "arm/flange.origin", "second": "box/lid"})";
  const auto refused = [&](const std::string& surface, const std::string& word) {
    test::expect_refused(files_, scene(one, "", R"(, {"name": "s", "surface": )" + surface + "}"),
                         {word});
  };
  refused(R"({"point": [0, 0, 0], "normal": [0, 0, 1], "radius": 0})", "an empty surface");
  refused(R"({"point": [0, 0, 0], "normal": [0, 0, 1]})", "'radius' is missing");
  refused(R"({"point": [0, 0, 0], "normal": [0, 0, 0], "radius": 1})", "length 0");
  refused(R"({"outline": [[0, 0, 0], [1, 0, 0]]})", "from 3 to 256 corners");
  refused(R"({"outline": [[0, 0, 0], [1, 0, 0], [2, 0, 0]]})", "on a line");
  refused(R"({"outline": [[0, 0, 0], [1, 0, 0.1], [1, 1, 0], [0, 1, 0]]})", "in one plane");
  refused(R"({"outline": [[0, 0, 0], [4, 0, 0], [1, 1, 0], [0, 4, 0]]})", "convex outline once");
  refused(R"({"outline": [[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]]})", "at another place");
  refused(R"({"outline": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "radius": 1})",
          "'radius' is not known");
}

}  // namespace
}  // namespace kaboum::world
