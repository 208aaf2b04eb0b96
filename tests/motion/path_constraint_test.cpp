// Constraints kept at every instant, against samples of the motion by forward kinematics of other
// code, with tolerances just above and just below the largest deviation.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/motion/find_path.h>
#include <kaboum/motion/goals.h>
#include <kaboum/motion/keep_options.h>

#include <cmath>
#include <random>

#include "kinematics/surfaces.h"
#include "random_scene.h"
#include "world/worlds.h"

namespace kaboum::motion {
namespace {

using geom::Transform;
using geom::Vec3;
using kinematics::Feature;
using kinematics::Line;
using kinematics::Plane;
using kinematics::Point;
using kinematics::Relation;
using kinematics::Surface;
using Kept = ConstraintAnswer::Outcome;
using Wide = Eigen::Matrix<long double, 3, 1>;
using WideMatrix = Eigen::Matrix<long double, 3, 3>;

double between(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3 random_direction(std::mt19937_64& random) {
  Vec3 d;
  do d = Vec3(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1));
  while (d.norm() > 1 || d.norm() < 0.1);
  return d.normalized();
}

/// A rotation and a translation.
struct WidePose {
  WideMatrix linear = WideMatrix::Identity();
  Wide translation = Wide::Zero();

  WidePose operator*(const WidePose& other) const {
    return {linear * other.linear, linear * other.translation + translation};
  }
};

WidePose wide(const Transform& t) {
  return {t.linear.cast<long double>(), t.translation.cast<long double>()};
}

/// Rodrigues' formula.
WideMatrix turned(const Wide& axis, long double angle) {
  WideMatrix cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return WideMatrix::Identity() + std::sin(angle) * cross + (1 - std::cos(angle)) * (cross * cross);
}

WidePose pose_of(const world::RobotModel& model, const std::vector<long double>& q,
                 std::uint32_t link) {
  WidePose pose;
  for (std::uint32_t l = link; l != 0;) {
    const robot::Joint& joint = model.kinematics.joints[l - 1];
    WidePose moved;
    const Wide axis = joint.axis.cast<long double>();
    if (joint.type != robot::JointType::Fixed) {
      const long double value = joint.multiplier * q[joint.variable] + joint.offset;
      if (joint.type == robot::JointType::Revolute)
        moved.linear = turned(axis, value);
      else
        moved.translation = value * axis;
    }
    pose = wide(joint.origin) * moved * pose;
    l = joint.parent;
  }
  return wide(model.base) * pose;
}

/// Chains of turning and sliding joints, the last of which mimics the first.
world::RobotModel random_robot(std::mt19937_64& random) {
  world::RobotModel out;
  out.name = "robot";
  const auto count = 2 + random() % 5;
  out.kinematics.links.resize(count + 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    robot::Joint joint;
    joint.parent = i;
    joint.type = random() % 4 == 0 ? robot::JointType::Prismatic : robot::JointType::Revolute;
    joint.axis = random_direction(random);
    joint.origin = {Eigen::AngleAxisd(between(random, -3, 3), random_direction(random)).matrix(),
                    between(random, 0, 0.6) * random_direction(random)};
    const bool mimics = i > 0 && i + 1 == count && random() % 3 == 0;
    joint.variable = mimics ? 0 : i;
    if (mimics) joint.multiplier = between(random, -1.5, 1.5), joint.offset = 0.3;
    out.kinematics.joints.push_back(joint);
    if (!mimics) out.kinematics.variables.push_back({"j" + std::to_string(i), -3.0, 3.0, {}});
    out.kinematics.links[i + 1].name = "l" + std::to_string(i + 1);
  }
  out.kinematics.links[0].name = "root";
  out.base = {Eigen::AngleAxisd(between(random, -3, 3), random_direction(random)).matrix(),
              between(random, 0, 2) * random_direction(random)};
  out.home.assign(out.kinematics.variables.size(), 0);
  return out;
}

Feature random_feature(std::size_t kind, std::mt19937_64& random) {
  const Vec3 at = between(random, 0, 0.5) * random_direction(random);
  if (kind == 0) return Point{at};
  if (kind == 1) return Line{at, random_direction(random)};
  if (kind == 3) return test::random_surface(random, 0.3);
  return Plane{at, random_direction(random)};
}

struct Deviation {
  long double length = 0, angle = 0;
};

long double angle_of(const Wide& a, const Wide& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// How far a constraint is off, as a textbook has it.
/// @param sense  1 or −1: of directions that are to be parallel
Deviation deviation_of(const PathConstraint& c, const WidePose& pose, int sense) {
  Wide p = Wide::Zero(), u = Wide::UnitX(), r = Wide::Zero(), d = Wide::UnitX();
  const auto read = [](const Feature& f, Wide& position, Wide& direction) {
    if (const auto* point = std::get_if<Point>(&f)) position = point->position.cast<long double>();
    if (const auto* line = std::get_if<Line>(&f)) {
      position = line->position.cast<long double>();
      direction = line->direction.cast<long double>();
    }
    if (const auto* plane = std::get_if<Plane>(&f)) {
      position = plane->position.cast<long double>();
      direction = plane->normal.cast<long double>();
    }
    if (const auto* surface = std::get_if<Surface>(&f)) {
      position = surface->position.cast<long double>();
      direction = surface->normal.cast<long double>();
    }
  };
  read(c.moving, p, u);
  read(c.resting, r, d);
  p = pose.linear * p + pose.translation;
  u = pose.linear * u;
  const std::size_t moving = c.moving.index(), resting = c.resting.index();
  const bool mixed = moving != 0 && resting != 0 && (moving == 1) != (resting == 1);
  const long double right = std::acos(-1.0L) / 2;
  Deviation out;
  if (moving == 0 && resting == 3) {
    out.length = test::distance_from_surface<long double>(std::get<Surface>(c.resting), p, c.value);
    return out;
  }
  const auto distance = [&] {
    const Wide way = p - r;
    if (resting == 0) return way.norm();
    if (resting == 1) return way.cross(d).norm();
    return std::abs(way.dot(d));
  };
  const auto aligned = [&] { return angle_of(u, sense * d); };
  const auto square = [&] { return std::abs(right - angle_of(u, d)); };
  switch (c.relation) {
    case Relation::Coincident:
      out.length = distance();
      if (moving != 0) out.angle = mixed ? square() : aligned();
      break;
    case Relation::Distance:
      out.length = std::abs(distance() - c.value);
      break;
    case Relation::Parallel:
      out.angle = mixed ? square() : aligned();
      break;
    case Relation::Perpendicular:
      out.angle = mixed ? aligned() : square();
      break;
    case Relation::Angle:
      out.angle = std::abs((mixed ? right - angle_of(u, d) : angle_of(u, d)) - c.value);
      break;
  }
  return out;
}

std::vector<long double> values_at(const std::vector<double>& from, const std::vector<double>& to,
                                   long double share) {
  std::vector<long double> q;
  for (std::size_t i = 0; i < from.size(); ++i)
    q.push_back(from[i] + share * (static_cast<long double>(to[i]) - from[i]));
  return q;
}

/// The direction of a constraint's moving feature along that of the resting one at the start.
int sense_of(const PathConstraint& c, const WidePose& pose) {
  const Deviation same = deviation_of(c, pose, 1), other = deviation_of(c, pose, -1);
  return same.angle <= other.angle ? 1 : -1;
}

constexpr int kSamples = 4000;

/// The largest deviation seen on a segment.
Deviation largest(const world::RobotModel& robot, const PathConstraint& c,
                  const std::vector<double>& from, const std::vector<double>& to) {
  Deviation out;
  const int sense = sense_of(c, pose_of(robot, values_at(from, to, 0), c.link));
  for (int i = 0; i <= kSamples; ++i) {
    const auto q = values_at(from, to, static_cast<long double>(i) / kSamples);
    const Deviation d = deviation_of(c, pose_of(robot, q, c.link), sense);
    out.length = std::max(out.length, d.length);
    out.angle = std::max(out.angle, d.angle);
  }
  return out;
}

struct Combination {
  Relation relation;
  std::size_t moving, resting;
};
const std::vector<Combination> kCombinations{
    {Relation::Coincident, 0, 0}, {Relation::Coincident, 0, 1},    {Relation::Coincident, 0, 2},
    {Relation::Coincident, 1, 1}, {Relation::Coincident, 1, 2},    {Relation::Coincident, 2, 2},
    {Relation::Distance, 0, 0},   {Relation::Distance, 0, 1},      {Relation::Distance, 0, 2},
    {Relation::Parallel, 1, 1},   {Relation::Parallel, 2, 2},      {Relation::Parallel, 1, 2},
    {Relation::Parallel, 2, 1},   {Relation::Perpendicular, 1, 1}, {Relation::Perpendicular, 2, 2},
    {Relation::Angle, 1, 1},      {Relation::Perpendicular, 1, 2}, {Relation::Perpendicular, 2, 1},
    {Relation::Angle, 2, 2},      {Relation::Angle, 1, 2},         {Relation::Angle, 2, 1},
    {Relation::Coincident, 0, 3}, {Relation::Distance, 0, 3},      {Relation::Parallel, 3, 1},
    {Relation::Parallel, 3, 2},   {Relation::Perpendicular, 1, 3}, {Relation::Angle, 3, 3}};

class EachRelation : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EachRelation, IsKeptJustAboveTheLargestDeviationAndBrokenJustBelow) {
  const Combination& combination = kCombinations[GetParam()];
  std::mt19937_64 random(GetParam() + 1);
  int kept = 0, broken = 0;
  for (int round = 0; round < 40; ++round) {
    const world::RobotModel robot = random_robot(random);
    std::vector<double> from, to;
    const double size = round % 2 == 0 ? 1.5 : 0.1;
    for (std::size_t i = 0; i < robot.kinematics.variables.size(); ++i) {
      from.push_back(between(random, -1.5, 1.5));
      to.push_back(from.back() + between(random, -size, size));
    }
    PathConstraint c;
    c.name = "one";
    c.relation = combination.relation;
    c.link = static_cast<std::uint32_t>(robot.kinematics.links.size() - 1);
    c.moving = random_feature(combination.moving, random);
    c.resting = random_feature(combination.resting, random);
    if (c.relation == Relation::Distance) c.value = between(random, 0, 1);
    if (c.relation == Relation::Angle) c.value = between(random, 0, 1.5);
    require_keepable(c, robot.kinematics);
    const Deviation seen = largest(robot, c, from, to);
    // A sample is this near to the largest: angles beyond a right one turn their sense over.
    if (seen.length > 0.999 * 1e9 || seen.angle > 1.5) continue;
    const auto ask = [&](double factor) {
      c.within = std::max(1e-6, factor * static_cast<double>(seen.length));
      c.within_angle = std::max(1e-6, factor * static_cast<double>(seen.angle));
      return check_constraints(robot, {from, to}, {&c, 1});
    };
    const ConstraintAnswer above = ask(1.002);
    EXPECT_EQ(above.outcome, Kept::Kept) << "round " << round;
    kept += above.outcome == Kept::Kept ? 1 : 0;
    EXPECT_LE(above.parts.at(0), 1);
    const ConstraintAnswer below = ask(0.998);
    if (seen.length < 1e-5 && seen.angle < 1e-5) continue;
    EXPECT_EQ(below.outcome, Kept::Broken) << "round " << round;
    if (below.outcome != Kept::Broken) continue;
    ++broken;
    const WidePose start = pose_of(robot, values_at(from, to, 0), c.link);
    const Deviation there = deviation_of(
        c, pose_of(robot, values_at(from, to, below.share), c.link), sense_of(c, start));
    const long double off = below.of_direction ? there.angle : there.length;
    EXPECT_GT(off, below.of_direction ? c.within_angle : c.within);
    EXPECT_NEAR(static_cast<double>(off), below.deviation, 1e-9);
  }
  EXPECT_GT(kept, 20);
  EXPECT_GT(broken, 20);
}

// Wherever the joints are within `around` of a segment that keeps a constraint with it, it is kept.
TEST_P(EachRelation, IsKeptAroundASegment) {
  const Combination& combination = kCombinations[GetParam()];
  std::mt19937_64 random(GetParam() + 100);
  int kept = 0, refused = 0;
  for (int round = 0; round < 40; ++round) {
    const world::RobotModel robot = random_robot(random);
    std::vector<double> from, to;
    world::MotionOptions options;
    for (std::size_t i = 0; i < robot.kinematics.variables.size(); ++i) {
      from.push_back(between(random, -1.5, 1.5));
      to.push_back(from.back() + between(random, -0.1, 0.1));
      options.around.push_back(random() % 4 == 0 ? 0 : between(random, 0, 0.02));
    }
    PathConstraint c;
    c.name = "one";
    c.relation = combination.relation;
    c.link = static_cast<std::uint32_t>(robot.kinematics.links.size() - 1);
    c.moving = random_feature(combination.moving, random);
    c.resting = random_feature(combination.resting, random);
    if (c.relation == Relation::Distance) c.value = between(random, 0, 1);
    if (c.relation == Relation::Angle) c.value = between(random, 0.1, 1.5);
    const int sense = sense_of(c, pose_of(robot, values_at(from, to, 0), c.link));
    Deviation seen;
    for (int k = 0; k < 2000; ++k) {
      auto q = values_at(from, to, between(random, 0, 1));
      for (std::size_t i = 0; i < q.size(); ++i)
        q[i] += options.around[i] * (k % 2 == 0          ? between(random, -1, 1)
                                     : random() % 2 == 0 ? 1.0
                                                         : -1.0);
      const Deviation d = deviation_of(c, pose_of(robot, q, c.link), sense);
      seen.length = std::max(seen.length, d.length);
      seen.angle = std::max(seen.angle, d.angle);
    }
    if (seen.angle > 1.4) continue;
    const auto ask = [&](double factor) {
      c.within = std::max(1e-6, factor * static_cast<double>(seen.length));
      c.within_angle = std::max(1e-6, factor * static_cast<double>(seen.angle));
      return check_constraints(robot, {from, to}, {&c, 1}, options).outcome == Kept::Kept;
    };
    // What was seen breaks a tolerance that is a little smaller.
    if (seen.length > 1e-5 || seen.angle > 1e-5) {
      EXPECT_FALSE(ask(0.999)) << "round " << round;
      ++refused;
    }
    kept += ask(3) ? 1 : 0;
  }
  EXPECT_GT(refused, 15);
  EXPECT_GT(kept, 10);
}

INSTANTIATE_TEST_SUITE_P(Relations, EachRelation,
                         ::testing::Range(std::size_t{0}, kCombinations.size()));

TEST(PathConstraints, WhatIsAnswered) {
  // A bar that turns about z through half a turn: its end leaves the plane x = 1 at once, and is
  // back at the end of the whole turn.
  world::RobotModel robot;
  robot.kinematics.links.resize(2);
  robot.kinematics.links[0].name = "root";
  robot.kinematics.links[1].name = "bar";
  robot.kinematics.joints.push_back(
      {"j", robot::JointType::Revolute, 0, {}, Vec3::UnitZ(), 0, 1, 0});
  robot.kinematics.variables.push_back({"j", {}, {}, {}});
  robot.home = {0};
  PathConstraint c;
  c.name = "wall";
  c.link = 1;
  c.moving = Point{Vec3::UnitX()};
  c.resting = Plane{Vec3::UnitX(), Vec3::UnitX()};
  c.within = 0.01;
  const double whole = 2 * std::acos(-1.0);
  const ConstraintAnswer away = check_constraints(robot, {{0.0}, {whole}}, {&c, 1});
  EXPECT_EQ(away.outcome, Kept::Broken);
  EXPECT_EQ(describe(away, {&c, 1}), "'wall' is off by 2, 0.01 are allowed");
  c.within = 2.0001;
  EXPECT_EQ(check_constraints(robot, {{0.0}, {whole}}, {&c, 1}).outcome, Kept::Kept);
  // The tolerance itself is touched.
  c.within = 1 - std::cos(0.5);
  EXPECT_EQ(check_constraints(robot, {{0.0}, {0.5}}, {&c, 1}).outcome, Kept::Undecided);
  EXPECT_EQ(check_constraints(robot, {{0.0}, {0.49}}, {&c, 1}).outcome, Kept::Kept);
  const ConstraintAnswer later = check_constraints(robot, {{0.0}, {0.4}, {0.6}}, {&c, 1});
  EXPECT_EQ(later.outcome, Kept::Broken);
  EXPECT_EQ(later.segment, 1U);
  // One waypoint is a path too.
  EXPECT_EQ(check_constraints(robot, {{0.6}}, {&c, 1}).outcome, Kept::Broken);
  EXPECT_EQ(check_constraints(robot, {{0.4}}, {&c, 1}).outcome, Kept::Kept);
  EXPECT_EQ(check_constraints(robot, {{0.0}, {3.0}}, {}).outcome, Kept::Kept);
}

TEST(PathConstraints, EachIsOfItsOwnLink) {
  std::mt19937_64 random(7);
  world::RobotModel robot = random_robot(random);
  while (robot.kinematics.variables.size() < 4) robot = random_robot(random);
  std::vector<PathConstraint> constraints(2);
  const std::vector<double> from(robot.home.size(), 0.1), to(robot.home.size(), 1.1);
  for (std::uint32_t i = 0; i < 2; ++i) {
    PathConstraint& c = constraints[i];
    c.name = "of l" + std::to_string(i + 1);
    c.link = i + 1;
    c.moving = Point{Vec3(0.1, 0.2, 0.3)};
    c.resting = Point{};
    c.within = 1.002 * static_cast<double>(largest(robot, c, from, to).length);
  }
  EXPECT_EQ(check_constraints(robot, {from, to}, constraints).outcome, Kept::Kept);
  constraints[1].within *= 0.9;
  const ConstraintAnswer answer = check_constraints(robot, {from, to}, constraints);
  EXPECT_EQ(answer.outcome, Kept::Broken);
  EXPECT_EQ(answer.constraint, 1U);
  std::swap(constraints[0], constraints[1]);
  EXPECT_EQ(check_constraints(robot, {from, to}, constraints).outcome, Kept::Broken);
}

TEST(PathConstraints, NothingCertainIsLeftUndecided) {
  // A slide through the middle of a ring that it is to keep away from: no second derivative.
  world::RobotModel robot;
  robot.kinematics.links.resize(2);
  robot.kinematics.joints.push_back(
      {"j", robot::JointType::Prismatic, 0, {}, Vec3::UnitX(), 0, 1, 0});
  robot.kinematics.variables.push_back({"j", {}, {}, {}});
  robot.home = {0};
  PathConstraint c;
  c.name = "ring";
  c.relation = Relation::Distance;
  c.link = 1;
  c.value = 1;
  c.within = 0.9;
  const ConstraintAnswer through = check_constraints(robot, {{-1.0}, {1.8}}, {&c, 1});
  EXPECT_EQ(through.outcome, Kept::Broken);
  EXPECT_NEAR(through.deviation, 1, 1e-6);
  // At the very value, and nearer to its limit than rounding tells.
  c.value = 1000;
  c.within = 1e-10;
  EXPECT_NE(check_constraints(robot, {{1000.0}}, {&c, 1}).outcome, Kept::Broken);
  c.within = 0.001;
  EXPECT_EQ(check_constraints(robot, {{1000.0009}}, {&c, 1}).outcome, Kept::Kept);
  EXPECT_EQ(check_constraints(robot, {{1000.0010001}}, {&c, 1}).outcome, Kept::Broken);
  // A direction opposite to another one, as nearly as parallel ones.
  robot.kinematics.joints[0].type = robot::JointType::Revolute;
  c.relation = Relation::Angle;
  c.moving = Line{Vec3::Zero(), Vec3::UnitY()};
  c.resting = Line{Vec3::Zero(), -Vec3::UnitY()};
  c.value = std::acos(-1.0);
  c.within_angle = 1e-4;
  EXPECT_EQ(check_constraints(robot, {{0.0}, {0.9e-4}}, {&c, 1}).outcome, Kept::Kept);
  EXPECT_EQ(check_constraints(robot, {{0.0}, {1.1e-4}}, {&c, 1}).outcome, Kept::Broken);
  c.within_angle = 1e-6;
  EXPECT_EQ(check_constraints(robot, {{0.0}, {0.9e-6}}, {&c, 1}).outcome, Kept::Kept);
  // A limit ends the work: of a point on a circle that is nearly as large as it may be.
  c.relation = Relation::Distance;
  c.moving = Point{Vec3::UnitY()};
  c.resting = Point{};
  c.value = 0;
  c.within = 1.0001;
  EXPECT_EQ(check_constraints(robot, {{0.0}, {1e3}}, {&c, 1}).outcome, Kept::Kept);
  world::MotionOptions few;
  few.most_intervals = 50;
  const ConstraintAnswer long_way = check_constraints(robot, {{0.0}, {1e3}}, {&c, 1}, few);
  EXPECT_EQ(long_way.outcome, Kept::Undecided);
  EXPECT_LT(long_way.instants, 200U);
}

TEST(PathConstraints, WhatCannotBeKeptIsRefused) {
  std::mt19937_64 random(1);
  const world::RobotModel robot = random_robot(random);
  PathConstraint c;
  c.link = 1;
  c.resting = Point{};
  c.moving = Line{};
  EXPECT_THROW(require_keepable(c, robot.kinematics), Error);
  c.moving = Point{};
  EXPECT_NO_THROW(require_keepable(c, robot.kinematics));
  c.within = 0;
  EXPECT_THROW(require_keepable(c, robot.kinematics), Error);
  c.within = std::nan("");
  EXPECT_THROW(require_keepable(c, robot.kinematics), Error);
  c.within = 1;
  c.link = 99;
  EXPECT_THROW(require_keepable(c, robot.kinematics), Error);
  c.link = 1;
  c.relation = Relation::Parallel;
  EXPECT_THROW(require_keepable(c, robot.kinematics), Error);
}

/// A feature of a scene's robot, held against samples.
bool keeps(const world::RobotModel& robot, const robot::Path& path,
           const std::vector<PathConstraint>& constraints) {
  for (const PathConstraint& c : constraints) {
    const WidePose start = pose_of(robot, values_at(path[0], path[0], 0), c.link);
    const int sense = sense_of(c, start);
    for (std::size_t s = 0; s + 1 < path.size(); ++s)
      for (int i = 0; i <= 300; ++i) {
        const auto q = values_at(path[s], path[s + 1], static_cast<long double>(i) / 300);
        const Deviation d = deviation_of(c, pose_of(robot, q, c.link), sense);
        if (d.length > c.within || d.angle > c.within_angle) return false;
      }
  }
  return true;
}

TEST(FindPathWithConstraints, KeepsThemAmongThings) {
  int found = 0, would_break = 0, several = 0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    test::RandomScene scene = test::random_scene(seed, 6);
    const world::Checker checker(scene.world);
    const world::RobotModel& robot = scene.world.robots[0];
    std::mt19937_64 random(seed);
    PathConstraint level;
    level.name = "level";
    level.link = static_cast<std::uint32_t>(robot.kinematics.links.size() - 1);
    level.moving = Point{Vec3(0.4, 0, 0)};
    level.within = 0.03;
    world::WorldState state = initial_state(scene.world);
    world::Scratch scratch;
    const auto draw = [&](const std::vector<PathConstraint>& constraints) {
      for (int k = 0; k < 20'000; ++k) {
        state.q[0] = test::random_values(robot.kinematics, random);
        if (check_constraints(robot, {state.q[0]}, constraints).outcome == Kept::Kept &&
            !checker.find_contact(state, scratch))
          return state.q[0];
      }
      ADD_FAILURE() << "no configuration is drawn";
      return robot.home;
    };
    for (int query = 0; query < 4; ++query) {
      const std::vector<double> start = draw({});
      const WidePose pose = pose_of(robot, values_at(start, start, 0), level.link);
      const Wide at = pose.linear * Wide(0.4L, 0, 0) + pose.translation;
      level.resting = Plane{at.cast<double>(), Vec3::UnitZ()};
      const std::vector<double> goal = draw({level});
      PathOptions options;
      options.most_work = 1;
      options.constraints = {level};
      const PathAnswer answer =
          find_path(checker, initial_state(scene.world), 0, start, {{goal}}, options);
      const PathAnswer again =
          find_path(checker, initial_state(scene.world), 0, start, {{goal}}, options);
      EXPECT_EQ(answer.path, again.path);
      if (answer.outcome != PathAnswer::Outcome::Found) continue;
      ++found;
      several += answer.path.size() > 3 ? 1 : 0;
      EXPECT_TRUE(keeps(robot, answer.path, {level})) << "seed " << seed << ", query " << query;
      EXPECT_EQ(answer.path.front(), start);
      EXPECT_EQ(answer.path.back(), goal);
      ASSERT_EQ(answer.deviations.size(), 1U);
      EXPECT_LE(answer.deviations[0], 1);
      EXPECT_EQ(check_motion(checker, initial_state(scene.world), 0, answer.path, {}).outcome,
                world::MotionAnswer::Outcome::Free);
      options.constraints.clear();
      const PathAnswer plain =
          find_path(checker, initial_state(scene.world), 0, start, {{goal}}, options);
      if (plain.outcome == PathAnswer::Outcome::Found && !keeps(robot, plain.path, {level}))
        ++would_break;
    }
  }
  EXPECT_GT(found, 12);
  EXPECT_GT(several, 8);
  EXPECT_GT(would_break, 8);
}

TEST(FindPathWithConstraints, SaysWhatBreaksThem) {
  const test::SceneFiles files;
  const world::World world = files.world(files.scene());
  const world::Checker checker(world);
  PathOptions options;
  options.constraints.resize(1);
  PathConstraint& c = options.constraints[0];
  c.name = "near";
  c.link = 3;
  c.moving = Point{Vec3::UnitX()};
  c.resting = Point{Vec3(3, 0, 0)};
  c.within = 0.5;
  const auto find = [&](const std::vector<double>& start, const std::vector<double>& goal) {
    return find_path(checker, initial_state(world), 0, start, {{goal}}, options);
  };
  EXPECT_EQ(find({1, 0, 0}, {0, 0, 0}).outcome, PathAnswer::Outcome::StartBreaksConstraint);
  const PathAnswer answer = find({0, 0, 0}, {1, 0, 0});
  EXPECT_EQ(answer.outcome, PathAnswer::Outcome::GoalBreaksConstraint);
  ASSERT_TRUE(answer.broken);
  EXPECT_NE(describe(*answer.broken, options.constraints).find("'near' is off by 2.87"),
            std::string::npos)
      << describe(*answer.broken, options.constraints);
  EXPECT_EQ(find({0, 0, 0}, {0.1, 0, 0}).outcome, PathAnswer::Outcome::Found);
}

class UsualNames : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<PathConstraint> make(const KeepRequest& request) const {
    const std::vector<std::vector<double>> goals{{0.5, 0.2, 0}};
    return constraints_of(world_, initial_state(world_), 0, {0, 0.1, 0.2}, goals, request);
  }
  void expect_refused(const KeepRequest& request, const std::string& words) const {
    try {
      static_cast<void>(make(request));
      ADD_FAILURE() << "accepted, no '" << words << "'";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  test::SceneFiles files_;
  world::World world_ = files_.world(
      files_.scene(R"("objects": [{"name": "box", "outer": )" + files_.ref("box.glb") + R"(}],
      "constraints": [
        {"name": "on-wall", "all": [{"relation": "coincident", "first": "world.yz", "second": "arm/flange.origin", "within": 0.1}]},
        {"name": "of-box", "all": [{"relation": "parallel", "first": "box.z", "second": "arm/l2.z", "within_angle": 0.3}]},
        {"name": "fixed", "all": [{"relation": "parallel", "first": "box.z", "second": "world.z"}]},
        {"name": "within", "all": [{"relation": "parallel", "first": "arm/l1.z", "second": "arm/l2.z"}]}])",
                   R"("tools": [{"name": "flange", "link": "l3", "position": [1, 0, 0]}])"));
};

TEST_F(UsualNames, AreConstraintsOfTheTool) {
  const auto upright = make({{"upright"}, ""});
  ASSERT_EQ(upright.size(), 1U);
  EXPECT_EQ(upright[0].within_angle, 0.05);
  EXPECT_EQ(upright[0].link, 3U);
  EXPECT_EQ(make({{"orientation=0.1"}, ""}).size(), 2U);
  EXPECT_EQ(make({{"orientation=0.1"}, ""})[1].within_angle, 0.1);
  const auto both = make({{"line=0.01", "on-wall"}, "flange"});
  ASSERT_EQ(both.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<Line>(both[0].resting));
  EXPECT_EQ(both[0].within, 0.01);
  EXPECT_TRUE(std::holds_alternative<Point>(both[1].moving));
  EXPECT_TRUE(std::holds_alternative<Plane>(both[1].resting));
  EXPECT_EQ(both[1].within, 0.1);
  EXPECT_EQ(make({{"line=10mm"}, "flange"})[0].within, 0.01);
  EXPECT_EQ(make({{"level=1cm"}, "flange"})[0].within, 0.01);
  EXPECT_EQ(make({{"of-box"}, ""})[0].link, 2U);
  EXPECT_EQ(words_of(both, std::vector<double>{0.5, 0.25}),
            "line within 0.01 (50 % of it seen); on-wall within 0.1 (25 % of it seen)");
  // Each is met by the start, and the line by the goal.
  for (const char* name : {"upright", "orientation", "line", "level"}) {
    const auto made = make({{name}, ""});
    EXPECT_EQ(check_constraints(world_.robots[0], {{0, 0.1, 0.2}}, made).outcome, Kept::Kept)
        << name;
  }
  EXPECT_EQ(check_constraints(world_.robots[0], {{0.5, 0.2, 0}}, make({{"line"}, ""})).outcome,
            Kept::Kept);
}

TEST_F(UsualNames, ComeWithWhatIsCarriedUpright) {
  world_.objects[0].upright = 0.3;
  EXPECT_TRUE(make({}).empty());
  world::WorldState state = initial_state(world_);
  state.attachments[0] = world::Attachment{0, 2, {}, {}};
  const std::vector<std::vector<double>> goals{{0.5, 0.2, 0}};
  const auto made = constraints_of(world_, state, 0, {0, 0.1, 0.2}, goals, {});
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].name, "box upright");
  EXPECT_EQ(made[0].link, 2U);
  EXPECT_EQ(made[0].within_angle, 0.3);
  // The arm is plane: the box stands. Held upside down it does not, though it is parallel.
  EXPECT_EQ(check_constraints(world_.robots[0], {{0, 0.1, 0.2}}, made).outcome, Kept::Kept);
  state.attachments[0]->pose.linear = Vec3(1, -1, -1).asDiagonal();
  const auto over = constraints_of(world_, state, 0, {0, 0.1, 0.2}, goals, {});
  EXPECT_EQ(check_constraints(world_.robots[0], {{0, 0.1, 0.2}}, over).outcome, Kept::Broken);
}

TEST_F(UsualNames, AreRefusedWithWhatWouldHelp) {
  expect_refused({{"uprigt"}, ""}, "did you mean 'upright'?");
  expect_refused({{"on-wal"}, ""}, "did you mean 'on-wall'?");
  expect_refused({{"upright=0"}, ""}, "a tolerance of 'upright' is an angle above 0");
  expect_refused({{"upright=nan"}, ""}, "a tolerance of 'upright' is an angle above 0");
  expect_refused({{"upright=5mm"}, ""}, "in radians, without a unit");
  expect_refused({{"level=5 mm"}, ""}, "a tolerance of 'level' is a length above 0");
  expect_refused({{"level=1%"}, ""}, "nothing that it could be a percentage of");
  expect_refused({{"line=2"}, ""}, "less than 10 tolerances");
  expect_refused({{"on-wall"}, "flang"}, "did you mean 'flange'?");
  expect_refused({{"on-wall=2"}, ""}, "the scene states the tolerances");
  expect_refused({{"upright"}, "flang"}, "did you mean 'flange'?");
  EXPECT_EQ(make({{"upright,on-wall"}, "l2"}).size(), 2U);
  expect_refused({{"fixed"}, ""}, "no part that moves with robot 'arm'");
  expect_refused({{"within"}, ""}, "between two parts of robot 'arm'");
}

TEST(PoseGoals, ReachThePoseWithTheOtherJointsAsTheyAre) {
  const test::SceneFiles files;
  const world::World world = files.world(
      files.scene("", R"("tools": [{"name": "flange", "link": "l2", "position": [1, 0, 0]}])"));
  const world::RobotModel& robot = world.robots[0];
  const world::ToolFrame tool = moving_frame(robot, "");
  const std::vector<double> known{0.4, 0.7, -0.3}, start{0, 0, -0.3};
  const WidePose wanted = pose_of(robot, values_at(known, known, 0), 2) * wide(tool.pose);
  const Goals goals = pose_goals(
      robot, tool, {wanted.linear.cast<double>(), wanted.translation.cast<double>()}, start, 1);
  ASSERT_FALSE(goals.configurations.empty()) << goals.why;
  for (const std::vector<double>& q : goals.configurations) {
    EXPECT_EQ(q[2], -0.3);
    const WidePose there = pose_of(robot, values_at(q, q, 0), 2) * wide(tool.pose);
    EXPECT_LT((there.translation - wanted.translation).norm(), 1e-6);
    EXPECT_LT((there.linear - wanted.linear).norm(), 1e-6);
  }
  EXPECT_TRUE(pose_goals(robot, tool, {Eigen::Matrix3d::Identity(), Vec3(5, 0, 0)}, start, 1)
                  .configurations.empty());
}

TEST(ConstraintGoals, MeetTheConstraintsWithinTheLimits) {
  const test::SceneFiles files;
  const world::World world = files.world(files.scene(
      R"("constraints": [
        {"name": "on-wall", "all": [{"relation": "coincident", "first": "world.yz", "second": "arm/flange.origin"},
                                    {"relation": "parallel", "first": "arm/flange.x", "second": "world.y"}]},
        {"name": "elbow", "all": [{"relation": "distance", "first": "arm/l2.origin", "second": "world.zx", "value": 0.5}]},
        {"name": "nowhere", "all": [{"relation": "coincident", "first": "arm/flange.origin", "second": "world.xy"},
                                    {"relation": "distance", "first": "arm/flange.origin", "second": "world.origin", "value": 2}]},
        {"name": "preferred", "all": [{"relation": "distance", "first": "arm/l2.origin", "second": "world.zx", "value": 0.5}],
         "prefer": [{"relation": "parallel", "first": "arm/flange.x", "second": "world.y"},
                    {"relation": "coincident", "first": "arm/flange.origin", "second": "world.xy"}]}])",
      R"("tools": [{"name": "flange", "link": "l3", "position": [1, 0, 0]}])"));
  const world::RobotModel& robot = world.robots[0];
  const auto goals_of = [&](const char* name, std::uint64_t seed) {
    return constraint_goals(
        robot, robot.tools[0],
        path_constraints(world, initial_state(world), 0, world.constraint_set(name)), {0, 0, 0},
        seed);
  };
  const Goals wall = goals_of("on-wall", 1), elbow = goals_of("elbow", 1);
  EXPECT_GT(wall.configurations.size(), 4U);
  EXPECT_GT(elbow.configurations.size(), 4U);
  for (const std::vector<double>& q : wall.configurations) {
    EXPECT_NEAR(std::cos(q[0]) + std::cos(q[0] + q[1]) + std::cos(q[0] + q[1] + q[2]), 0, 1e-3);
    EXPECT_NEAR(std::cos(q[0] + q[1] + q[2]), 0, 0.021);
    for (const double x : q) EXPECT_LE(std::abs(x), 3);
  }
  for (const std::vector<double>& q : elbow.configurations)
    EXPECT_NEAR(std::abs(std::sin(q[0])), 0.5, 2e-3);
  EXPECT_TRUE(goals_of("nowhere", 1).configurations.empty());
  // The first preference is met, as the second one cannot be.
  const Goals preferred =
      preferred_goals(world, 0, robot.tools[0], world.constraint_set("preferred"), {0, 0, 0}, 1);
  EXPECT_GT(preferred.configurations.size(), 2U);
  for (const std::vector<double>& q : preferred.configurations) {
    EXPECT_NEAR(std::abs(std::sin(q[0])), 0.5, 2e-3);
    EXPECT_NEAR(std::cos(q[0] + q[1] + q[2]), 0, 0.021);
  }
  EXPECT_EQ(
      path_constraints(world, initial_state(world), 0, world.constraint_set("preferred"), 9).size(),
      3U);
  EXPECT_EQ(goals_of("on-wall", 1).configurations, wall.configurations);
  EXPECT_NE(goals_of("on-wall", 2).configurations, wall.configurations);
}

}  // namespace
}  // namespace kaboum::motion
