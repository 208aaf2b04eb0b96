// Point clouds against brute force: whole numbers, which decide touching exactly, and a world in
// which every ball is an object of its own.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/robot.h>
#include <kaboum/world/cloud.h>
#include <kaboum/world/motion_check.h>

#include <cmath>
#include <random>

namespace kaboum::world {
namespace {

using collide::Direction;
using collide::PosedSet;
using geom::ConvexBody;

ConvexBody cube(double half) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back((k & 1) != 0 ? half : -half, (k & 2) != 0 ? half : -half,
                         (k & 4) != 0 ? half : -half);
  return {"", *geom::convex_hull(corners), 0};
}

/// Whether the ball of a radius round a point meets the cube; of whole numbers, without rounding.
bool meets(const Vec3& p, std::int64_t half, std::int64_t radius) {
  std::int64_t sum = 0;
  for (const double x : p) {
    const std::int64_t beyond =
        std::max<std::int64_t>(0, std::abs(static_cast<std::int64_t>(x)) - half);
    sum += beyond * beyond;
  }
  return sum <= radius * radius;
}

World world_of(const std::vector<Vec3>& points, double radius) {
  World out;
  add_cloud(out, {.name = "scan", .points = points, .radius = radius});
  return out;
}

std::optional<std::uint32_t> touched(const World& world, const PosedSet& set, double slack = 0) {
  const auto found = find_collision(set, PosedSet(world.objects[0].outer), slack);
  if (!found) return std::nullopt;
  return world.point_of({Item::kObject, 0}, found->b);
}

/// Of so many points, none or exactly one is in contact, often by touching: whether that one is
/// found, and no other.
TEST(Cloud, FindsTheOnePointThatTouches) {
  constexpr std::int64_t kHalf = 40, kRadius = 25;
  const collide::BoundingSet set({cube(kHalf)}, Direction::Outer, 0);
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> any(-120, 120);
  for (const std::size_t count : {1U, 63U, 64U, 65U, 100U, 4096U, 4097U, 70'000U}) {
    std::vector<Vec3> far, near, touching;
    while (far.size() < count || near.size() < 20 || touching.size() < 20) {
      const Vec3 p(any(random), any(random), any(random));
      if (!meets(p, kHalf, kRadius))
        far.push_back(p);
      else
        (meets(p, kHalf, kRadius - 1) ? near : touching).push_back(p);
      if (far.size() > count) far.resize(count);
    }
    EXPECT_FALSE(touched(world_of(far, kRadius), PosedSet(set)));
    for (const auto* list : {&near, &touching})
      for (std::size_t i = 0; i < (count > 10'000 ? 3 : 20); ++i) {
        std::vector<Vec3> points = far;
        const std::size_t at = random() % points.size();
        points[at] = (*list)[i];
        EXPECT_EQ(touched(world_of(points, kRadius), PosedSet(set)), at + 1);
        // As the other one of the two, and by slack.
        const World world = world_of(points, kRadius - 5);
        EXPECT_EQ(touched(world, PosedSet(set), 5), at + 1);
        EXPECT_TRUE(find_collision(PosedSet(world.objects[0].outer), PosedSet(set), 5));
        const World full = world_of(points, kRadius);
        EXPECT_TRUE(list == &touching ||
                    certainly_collide(PosedSet(set), PosedSet(full.objects[0].outer)));
      }
  }
}

/// Touching is by exact squares: 15² + 20² = 25².
TEST(Cloud, TouchingIsExact) {
  const collide::BoundingSet set({cube(40)}, Direction::Outer, 0);
  std::vector<Vec3> points(500, Vec3(1000, 0, 0));
  points[321] = {55, 60, 0};
  EXPECT_EQ(touched(world_of(points, 25), PosedSet(set)), 322U);
  EXPECT_FALSE(touched(world_of(points, std::nextafter(25.0, 0)), PosedSet(set)));
  points[321].x() = std::nextafter(55.0, 60);
  EXPECT_FALSE(touched(world_of(points, 25), PosedSet(set)));
}

constexpr const char* kArm = R"(<robot name="arm">
  <link name="base"/><link name="upper"/><link name="tip"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="upper"/><child link="tip"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
</robot>)";

World arm() {
  World out;
  RobotModel robot;
  robot.name = "arm";
  robot.kinematics = robot::parse_urdf(kArm, "arm.urdf");
  robot.home = {0, 0};
  robot.shapes.push_back(
      {1, {{{"", {{{0, 0, 0}, {0.5, 0, 0}}, {}}, 0.06}}, Direction::Outer, 0}, {}});
  robot.shapes.push_back({2, {{cube(0.1)}, Direction::Outer, 0}, {}});
  robot.allowed.push_back({1, 2, AllowedPair::Reason::Stated});
  out.robots.push_back(std::move(robot));
  return out;
}

std::vector<Vec3> points_around(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(Vec3(normal(random), normal(random), normal(random)).normalized() *
                  (0.4 + 0.25 * std::abs(normal(random))));
  return out;
}

TEST(Cloud, AnswersAreThoseOfAnObjectForEachPoint) {
  const geom::Transform pose{robot::rotation_from_rpy(0.3, 0.2, 1.1), {0.1, -0.2, 0.05}};
  const std::vector<Vec3> points = points_around(150, 3);
  World cloud = arm(), objects = arm();
  add_cloud(cloud, {.name = "scan", .points = points, .radius = 0.02, .pose = pose});
  for (std::size_t i = 0; i < points.size(); ++i) {
    Object ball{.name = "ball " + std::to_string(i + 1),
                .pose = pose,
                .outer = {{{"", {{points[i]}, {}}, 0.02}}, Direction::Outer, 0},
                .inner = {},
                .features = {},
                .grasps = {}};
    objects.objects.push_back(std::move(ball));
    objects.attachments.emplace_back();
  }
  const Checker one(cloud), many(objects);
  Scratch scratch, others;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-3, 3);
  std::size_t free = 0, free_motions = 0;
  for (int i = 0; i < 400; ++i) {
    WorldState a = initial_state(cloud), b = initial_state(objects);
    a.q[0] = b.q[0] = {any(random), any(random)};
    const auto contacts = one.find_contacts(a, scratch, {});
    const auto expected = many.find_contacts(b, others, {});
    EXPECT_EQ(contacts.empty(), expected.empty());
    free += contacts.empty() ? 1 : 0;
    for (const Contact& c : contacts) {
      EXPECT_TRUE(c.certain || c.epsilon > 0);
      // The point that is named is one in contact.
      const std::string name = "ball " + std::to_string(*cloud.point_of(c.items[1], c.bodies.b));
      EXPECT_TRUE(std::ranges::any_of(expected, [&](const Contact& e) {
        return e.items[0] == c.items[0] && objects.name_of(e.items[1]) == name;
      }));
    }
    const auto nearest = one.find_nearest(a, scratch, {}),
               by_balls = many.find_nearest(b, others, {});
    EXPECT_LE(nearest->clearance.lower, by_balls->clearance.upper);
    EXPECT_GE(nearest->clearance.upper, by_balls->clearance.lower);
    if (i % 4 != 0) continue;
    const robot::Path path{a.q[0], {a.q[0][0] + 0.2, a.q[0][1] - 0.1}};
    const auto motion = check_motion(one, a, 0, path, {}),
               reference = check_motion(many, b, 0, path, {});
    EXPECT_EQ(motion.outcome, reference.outcome);
    free_motions += motion.outcome == MotionAnswer::Outcome::Free ? 1 : 0;
  }
  EXPECT_GT(free, 20U);
  EXPECT_LT(free, 380U);
  EXPECT_GT(free_motions, 5U);
}

/// A coordinate that is NaN is refused wherever it is: comparisons pass over one.
TEST(Cloud, PlacesThatAreNoNumbersAreRefused) {
  World world = arm();
  add_cloud(world, {.name = "cloud", .points = {{9, 9, 9}}, .radius = 0.1});
  const Checker checker(world);
  for (int k = 0; k < 3; ++k)
    for (const double bad : {std::nan(""), HUGE_VAL, -2e9}) {
      WorldState state = initial_state(world);
      state.poses[0].translation[k] = bad;
      Scratch scratch;
      EXPECT_THROW(checker.pairs(state, {}), Error) << k;
      EXPECT_THROW(checker.is_free(state, scratch), Error) << k;
    }
}

TEST(Cloud, LinksMayBeAllowedToTouchIt) {
  World world = arm();
  add_cloud(world,
            {.name = "scan", .points = {{0.25, 0, 0}}, .radius = 0.01, .allow = {"arm/upper"}});
  const Checker checker(world);
  Scratch scratch;
  EXPECT_TRUE(checker.is_free(initial_state(world), scratch));
  World strict = arm();
  add_cloud(strict, {.name = "scan", .points = {{0.25, 0, 0}}, .numbers = {17}, .radius = 0.01});
  const Checker other(strict);
  const auto contact = other.find_contact(initial_state(strict), scratch);
  ASSERT_TRUE(contact);
  EXPECT_TRUE(contact->certain);
  EXPECT_EQ(strict.point_of(contact->items[1], contact->bodies.b), 17U);
  EXPECT_FALSE(strict.point_of(contact->items[0], contact->bodies.a));
}

TEST(Cloud, WhatMakesNoSenseIsRefused) {
  const std::vector<Vec3> one{Vec3::Zero()};
  const auto refused = [](Cloud cloud) {
    World world = arm();
    add_cloud(world, {.name = "there", .points = {{5, 5, 5}}, .radius = 1});
    const std::size_t before = world.objects.size();
    try {
      add_cloud(world, std::move(cloud));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_EQ(world.objects.size(), before);
      EXPECT_TRUE(world.allowed.empty());
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto has = [](const std::string& text, const char* words) {
    return text.find(words) != std::string::npos;
  };
  EXPECT_TRUE(has(refused({.name = "there", .points = one, .radius = 1}), "another one"));
  EXPECT_TRUE(has(refused({.name = "arm", .points = one, .radius = 1}), "another one"));
  EXPECT_TRUE(has(refused({.name = "a/b", .points = one, .radius = 1}), "without '/'"));
  EXPECT_TRUE(has(refused({.points = one}), "radius"));
  EXPECT_TRUE(has(refused({.points = one, .radius = NAN}), "radius"));
  EXPECT_TRUE(has(refused({.points = one, .radius = HUGE_VAL}), "radius"));
  EXPECT_TRUE(has(refused({.points = {}, .radius = 1}), "no points"));
  EXPECT_TRUE(has(refused({.points = {Vec3::Zero(), {0, NAN, 0}}, .radius = 1}), "point 2"));
  EXPECT_TRUE(has(refused({.points = one, .numbers = {1, 2}, .radius = 1}), "other numbers"));
  EXPECT_TRUE(
      has(refused({.points = one, .radius = 1, .allow = {"arm/upper", "arm/tap"}}), "arm/tip"));
}

}  // namespace
}  // namespace kaboum::world
