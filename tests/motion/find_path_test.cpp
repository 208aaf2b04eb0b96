// Paths that are found, against exact meshes at 1 kHz; and what is said where none is.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/motion/find_path.h>
#include <kaboum/motion/path_finder.h>
#include <kaboum/motion/trajectory.h>

#include "random_scene.h"
#include "world/worlds.h"

namespace kaboum::motion {
namespace {

using test::random_scene;
using test::RandomScene;
using test::SceneFiles;
using Outcome = PathAnswer::Outcome;
using Values = std::vector<double>;
using geom::Vec3;

PathAnswer find(const world::Checker& checker, const Values& start, const Values& goal,
                const PathOptions& options = {}) {
  return find_path(checker, initial_state(checker.world()), 0, start, {{goal}}, options);
}

/// The first of all samples of the path's execution at 1 kHz that is in contact.
std::optional<std::string> contact_on(const robot::Path& path, const test::ExactScene& exact) {
  const std::size_t count = path.front().size();
  const Trajectory trajectory(path, {Values(count, 4), Values(count, 30)}, 1000);
  for (std::size_t k = 0; k < trajectory.samples(); ++k)
    if (auto contact = exact.find_contact(trajectory.sample(k)))
      return *contact + " at sample " + std::to_string(k);
  return std::nullopt;
}

Values random_free(const world::Checker& checker, std::mt19937_64& random) {
  world::WorldState state = initial_state(checker.world());
  world::Scratch scratch;
  do state.q[0] = test::random_values(checker.world().robots[0].kinematics, random);
  while (checker.find_contact(state, scratch));
  return state.q[0];
}

TEST(FindPath, PathsOfRandomScenesAreFreeOfTheExactMeshesAt1kHz) {
  int straight = 0, round = 0, none = 0;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const RandomScene scene = random_scene(seed, 14);
    const world::Checker checker(scene.world);
    std::mt19937_64 random(seed);
    for (int query = 0; query < 3; ++query) {
      const Values start = random_free(checker, random), goal = random_free(checker, random);
      PathOptions options;
      options.most_work = 0.2;
      options.seed = static_cast<std::uint64_t>(query) + 1;
      const PathAnswer answer = find(checker, start, goal, options);
      if (answer.outcome != Outcome::Found) {
        EXPECT_TRUE(answer.path.empty());
        ++none;
        continue;
      }
      ++(answer.straight ? straight : round);
      EXPECT_EQ(answer.path.front(), start);
      EXPECT_EQ(answer.path.back(), goal);
      const auto contact = contact_on(answer.path, scene.exact);
      EXPECT_FALSE(contact) << "seed " << seed << ", query " << query << ": " << *contact;
    }
  }
  EXPECT_GT(straight, 1);
  EXPECT_GT(round, 6);
  EXPECT_LT(none, 6);
}

/// Fingers that hold something stay where they are, whatever the search tries.
/// A chain of so many links among posts, which all turn.
world::World snake(std::size_t joints, std::mt19937_64& random) {
  const double length = 1.5 / static_cast<double>(joints);
  const auto capsule = [](const Vec3& a, const Vec3& b, double radius) {
    return collide::BoundingSet({{"", {{a, b}, {}}, radius}}, collide::Direction::Outer, 0);
  };
  world::World out;
  world::RobotModel arm;
  arm.name = "arm";
  arm.kinematics.name = "arm";
  arm.kinematics.links.emplace_back().name = "link0";
  for (std::uint32_t j = 0; j < joints; ++j) {
    const std::string number = std::to_string(j + 1);
    arm.kinematics.links.emplace_back().name = "link" + number;
    robot::Joint joint;
    joint.name = "joint" + number;
    joint.parent = j;
    joint.type = robot::JointType::Revolute;
    joint.origin.translation = {j == 0 ? 0 : length, 0, 0};
    joint.axis = j % 3 == 2 ? Vec3::UnitY() : Vec3::UnitZ();
    joint.variable = j;
    arm.kinematics.variables.push_back({joint.name, -2.5, 2.5});
    arm.kinematics.joints.push_back(joint);
    arm.shapes.push_back({j + 1, capsule({0.3 * length, 0, 0}, {0.9 * length, 0, 0}, 0.02), {}});
    if (j > 0) arm.allowed.push_back({j, j + 1, world::AllowedPair::Reason::Adjacent});
  }
  arm.home.assign(joints, 0.0);
  out.robots.push_back(std::move(arm));
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < 6; ++k) {
    const double angle = 3 * uniform(random), away = 0.8 + 0.5 * uniform(random);
    world::Object post{
        .name = "post" + std::to_string(k),
        .pose = {Eigen::Matrix3d::Identity(), {away * std::cos(angle), away * std::sin(angle), 0}},
        .outer = capsule({0, 0, -0.8}, {0, 0, 0.8}, 0.05),
        .inner = {},
        .features = {},
        .grasps = {}};
    out.objects.push_back(std::move(post));
    out.attachments.emplace_back();
  }
  return out;
}

/// Of so many joints nearly all samples are far from a node: some are taken where it is next to an
/// obstacle, too.
TEST(FindPath, ManyJointsNextToAnObstacle) {
  constexpr std::size_t kJoints = 36;
  int searched = 0, found = 0;
  for (std::uint32_t seed = 1; searched < 6; ++seed) {
    std::mt19937_64 random(seed);
    const world::World world = snake(kJoints, random);
    const world::Checker checker(world);
    world::WorldState state = initial_state(world);
    world::Scratch scratch;
    std::uniform_real_distribution<double> uniform(-1.2, 1.2);
    const auto drawn = [&](bool free) {
      do std::ranges::generate(state.q[0], [&] { return uniform(random); });
      while (checker.is_free(state, scratch) != free);
      return state.q[0];
    };
    const Values goal = drawn(true), blocked = drawn(false);
    Values start = drawn(true);
    double share = 0;
    for (double half = 0.5; half > 1e-4; half /= 2) {
      for (std::size_t k = 0; k < kJoints; ++k)
        state.q[0][k] = start[k] + (share + half) * (blocked[k] - start[k]);
      if (checker.is_free(state, scratch)) share += half;
    }
    for (std::size_t k = 0; k < kJoints; ++k) start[k] += share * (blocked[k] - start[k]);
    PathOptions options;
    options.most_work = 0.5;
    options.seed = seed;
    const PathAnswer answer =
        PathFinder(checker, initial_state(world), 0).find(start, {{goal}}, options);
    if (answer.straight) continue;
    ++searched;
    found += answer.outcome == Outcome::Found ? 1 : 0;
  }
  EXPECT_GE(found, 4);  // the others may have none
}

TEST(FindPath, WhatIsToStayStays) {
  std::size_t round = 0, moved = 0;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const RandomScene scene = random_scene(seed, 14);
    const world::Checker checker(scene.world);
    std::mt19937_64 random(seed);
    world::Scratch scratch;
    for (int query = 0; query < 4; ++query) {
      const Values start = random_free(checker, random);
      world::WorldState state = initial_state(checker.world());
      do {
        state.q[0] = test::random_values(checker.world().robots[0].kinematics, random);
        state.q[0].back() = start.back();
      } while (checker.find_contact(state, scratch));
      PathOptions options;
      options.most_work = 0.2;
      for (const bool stays : {true, false}) {
        options.still.clear();
        if (stays) options.still = {static_cast<std::uint32_t>(start.size() - 1)};
        const PathAnswer answer = find(checker, start, state.q[0], options);
        if (answer.outcome != Outcome::Found || answer.straight) continue;
        ++round;
        for (const Values& q : answer.path) {
          if (stays) EXPECT_EQ(q.back(), start.back());
          moved += q.back() != start.back() ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(round, 5U);
  EXPECT_GT(moved, 0U) << "it would move otherwise";
}

/// The arm of three links; a plate a quarter of a millimetre thick in the way of its tip.
class BehindAPlate : public ::testing::Test {
 protected:
  BehindAPlate() {
    files_.put(
        "plate.glb",
        test::set_of({test::box_mesh({-0.25, -0x1p-13, -0.5}, {0.25, 0x1p-13, 0.5})}, "outer", 0));
    world_ = files_.world(files_.scene(
        "\"objects\": [{\"name\": \"plate\", \"pose\": {\"position\": [2.7, 0, 0]}, \"outer\": " +
        files_.ref("plate.glb") + "}]"));
  }
  SceneFiles files_;
  world::World world_;
};

TEST_F(BehindAPlate, IsGoneRound) {
  const world::Checker checker(world_);
  const PathAnswer answer = find(checker, {-0.5, 0, 0}, {0.5, 0, 0});
  ASSERT_EQ(answer.outcome, Outcome::Found);
  EXPECT_FALSE(answer.straight);
  EXPECT_GT(answer.path.size(), 2U);
  const auto motion = check_motion(checker, initial_state(world_), 0, answer.path, {});
  EXPECT_EQ(motion.outcome, world::MotionAnswer::Outcome::Free);
  ASSERT_FALSE(answer.blockers.empty());
  EXPECT_EQ(world_.name_of(answer.blockers.front().items[1]), "plate");
}

TEST_F(BehindAPlate, TheSameSeedGivesTheSamePath) {
  const world::Checker checker(world_), other(world_);
  robot::Path first;
  std::size_t different = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const PathOptions options{.seed = seed};
    const PathAnswer a = find(checker, {-0.5, 0, 0}, {0.5, 0, 0}, options),
                     b = find(other, {-0.5, 0, 0}, {0.5, 0, 0}, options);
    ASSERT_EQ(a.outcome, Outcome::Found);
    EXPECT_EQ(a.path, b.path);
    EXPECT_EQ(a.spent.work, b.spent.work);
    different += a.path != first ? 1 : 0;
    first = a.path;
  }
  EXPECT_GT(different, 1U);
}

TEST_F(BehindAPlate, TimeEndsASearchButChangesNoPath) {
  const world::Checker checker(world_);
  const PathAnswer unlimited = find(checker, {-0.5, 0, 0}, {0.5, 0, 0});
  for (const double seconds : {1e-9, 1e-4, 1e-3, 1e-2, 1.0}) {
    const PathAnswer answer = find(checker, {-0.5, 0, 0}, {0.5, 0, 0}, {.most_seconds = seconds});
    if (answer.outcome == Outcome::Found) {
      EXPECT_EQ(answer.path, unlimited.path);
    } else {
      EXPECT_EQ(answer.outcome, Outcome::TimeEnded);
    }
  }
  EXPECT_EQ(find(checker, {-0.5, 0, 0}, {0.5, 0, 0}, {.most_seconds = 1e-9}).outcome,
            Outcome::TimeEnded);
}

TEST_F(BehindAPlate, ReasonsWhereNothingIsFound) {
  const world::Checker checker(world_);
  const PathAnswer start = find(checker, {0, 0, 0}, {0.5, 0, 0});
  EXPECT_EQ(start.outcome, Outcome::StartInContact);
  ASSERT_TRUE(start.contact);
  EXPECT_EQ(world_.name_of(start.contact->items[0]), "arm/l3");
  EXPECT_EQ(world_.name_of(start.contact->items[1]), "plate");
  EXPECT_EQ(find(checker, {-0.5, 0, 0}, {0, 0, 0}).outcome, Outcome::GoalInContact);
  const PathAnswer limit = find(checker, {-0.5, 0, 3.5}, {0.5, 0, 0});
  EXPECT_EQ(limit.outcome, Outcome::StartOutsideLimits);
  EXPECT_EQ(limit.variable, 2U);
  EXPECT_EQ(find(checker, {-0.5, 0, 0}, {0.5, -3.1, 0}).outcome, Outcome::GoalOutsideLimits);
  EXPECT_EQ(find(checker, {-0.5, 0, 0}, {0.5, 0, 0}, {.most_work = 1e-9}).outcome,
            Outcome::WorkEnded);
  EXPECT_EQ(find(checker, {-0.5, 0, 0}, {0.5, 0, 0}, {.most_nodes = 1}).outcome,
            Outcome::NodesEnded);
}

TEST_F(BehindAPlate, TheNearestOfTheGoalsThatAreFree) {
  const world::Checker checker(world_);
  const std::vector<Values> goals{{0, 0, 0}, {1.5, 0, 0}, {-0.6, 0, 0}, {9, 0, 0}};
  const PathAnswer answer = find_path(checker, initial_state(world_), 0, {-0.5, 0, 0}, goals, {});
  ASSERT_EQ(answer.outcome, Outcome::Found);
  EXPECT_EQ(answer.goal, 2U);
  EXPECT_EQ(answer.path.back(), goals[2]);
  const std::vector<Values> far{{1.5, 0, 0}};
  EXPECT_EQ(find_path(checker, initial_state(world_), 0, {-0.5, 0, 0}, far, {}).path.back(),
            far[0]);
}

TEST_F(BehindAPlate, AtTheGoalAlready) {
  const world::Checker checker(world_);
  const PathAnswer answer = find(checker, {-0.5, 0, 0}, {-0.5, 0, 0});
  EXPECT_EQ(answer.outcome, Outcome::Found);
  EXPECT_TRUE(answer.straight);
}

TEST_F(BehindAPlate, WhatIsCarriedMustPassToo) {
  // A block as wide as the gap would be: the same query with and without it.
  world::World world = files_.world(files_.scene(
      "\"objects\": [{\"name\": \"plate\", \"pose\": {\"position\": [2.7, 0, 0]}, \"outer\": " +
      files_.ref("plate.glb") + "}, {\"name\": \"block\", \"outer\": " + files_.ref("box.glb") +
      "}]"));
  const world::Checker checker(world);
  world::WorldState state = initial_state(world);
  state.poses[1].translation = {9, 9, 9};
  // The tip is folded back: the way past the plate is free, but not for what it holds.
  const Values start{-0.6, 1.5, 1.5}, goal{0.6, 1.5, 1.5};
  const std::vector<Values> goals{goal};
  const PathAnswer alone = find_path(checker, state, 0, start, goals, {});
  ASSERT_EQ(alone.outcome, Outcome::Found);
  world::Attachment held;
  held.link = 1;
  held.pose.translation = {2.6, 0, 0};
  state.attachments[1] = held;
  const PathAnswer carrying = find_path(checker, state, 0, start, goals, {.most_work = 0.2});
  if (carrying.outcome == Outcome::Found) {
    EXPECT_FALSE(carrying.straight);
    EXPECT_EQ(check_motion(checker, state, 0, carrying.path, {}).outcome,
              world::MotionAnswer::Outcome::Free);
  }
  EXPECT_TRUE(alone.straight);
}

TEST_F(BehindAPlate, WhatIsWrongIsRefused) {
  const world::Checker checker(world_);
  EXPECT_THROW(find(checker, {0, 0}, {0.5, 0, 0}), Error);
  EXPECT_THROW(find(checker, {0, 0, 0}, {0.5, 0, std::nan("")}), Error);
  EXPECT_THROW(find(checker, {0, 0, 0}, {1, 0, 0}, {.most_work = 0}), Error);
  EXPECT_THROW(find_path(checker, initial_state(world_), 0, {0, 0, 0}, {}, {}), Error);
  EXPECT_THROW(find_path(checker, initial_state(world_), 1, {0, 0, 0}, {{Values{0, 0, 0}}}, {}),
               Error);
  EXPECT_THROW(find_path(checker, {}, 0, {0, 0, 0}, {{Values{0, 0, 0}}}, {}), Error);
}

TEST(FindPath, AWallAllRoundIsNotGoneThrough) {
  // Boxes on both sides of the arm: the goal is free, but no way leads there.
  const SceneFiles files;
  std::string objects;
  for (const char* at : {"[0, 1, 0]", "[0, -1, 0]"})
    objects += std::string(objects.empty() ? "" : ",") + "{\"name\": \"o" +
               std::to_string(objects.size()) + "\", \"pose\": {\"position\": " + at +
               "}, \"outer\": " + files.ref("box.glb") + "}";
  const world::World world = files.world(files.scene("\"objects\": [" + objects + "]"));
  const world::Checker checker(world);
  const PathAnswer answer = find(checker, {0, 0, 0}, {3, 0, 0}, {.most_work = 0.3});
  EXPECT_EQ(answer.outcome, Outcome::WorkEnded);
  EXPECT_FALSE(answer.blockers.empty());
  EXPECT_GT(answer.spent.samples, 10U);
}

}  // namespace
}  // namespace kaboum::motion
