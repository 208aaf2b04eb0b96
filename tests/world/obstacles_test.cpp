// What is in the way of a path, each thing by itself; and things that are not looked at.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/world/motion_check.h>

#include <algorithm>
#include <random>

#include "worlds.h"

namespace kaboum::world {
namespace {

using test::SceneFiles;

World boxes_scene(const SceneFiles& files) {
  std::string text = "\"objects\": [";
  const std::vector<std::string> positions{"[2, 1.2, 0]", "[-1.5, 0.9, 0.3]", "[0.5, -2.2, 0]",
                                           "[0.3, 2.1, 0]", "[9, 9, 9]"};
  for (std::size_t i = 0; i < positions.size(); ++i)
    text += std::string(i == 0 ? "" : ",").append("{\"name\": \"o").append(std::to_string(i)) +
            "\", \"pose\": {\"position\": " + positions[i] +
            "}, \"outer\": " + files.ref("box.glb") + "}";
  return files.world(files.scene(text + "]"));
}

robot::Path random_path(std::mt19937_64& random) {
  std::uniform_real_distribution<double> turn(-3, 3), step(-0.7, 0.7);
  robot::Path path(3, std::vector<double>(3));
  for (double& q : path[0]) q = turn(random);
  for (std::size_t k = 1; k < 3; ++k)
    for (std::size_t j = 0; j < 3; ++j) path[k][j] = path[k - 1][j] + step(random);
  return path;
}

/// Objects that are met at samples of a path.
std::vector<Item> met_at_samples(const Checker& checker, WorldState state,
                                 const robot::Path& path) {
  Scratch scratch;
  std::vector<Item> out;
  for (std::size_t s = 0; s + 1 < path.size(); ++s)
    for (int k = 0; k <= 200; ++k) {
      for (std::size_t j = 0; j < 3; ++j)
        state.q[0][j] = path[s][j] + k / 200.0 * (path[s + 1][j] - path[s][j]);
      for (const Contact& contact : checker.find_contacts(state, scratch, {}))
        for (const Item& item : contact.items)
          if (item.robot == Item::kObject && !state.attachments[item.index]) out.push_back(item);
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

TEST(FindObstacles, AreWhatSamplesMeetEachByItself) {
  const SceneFiles files;
  const World world = boxes_scene(files);
  const Checker checker(world);
  std::mt19937_64 random(5);
  std::size_t found = 0, free = 0, beyond = 0;
  for (int i = 0; i < 120; ++i) {
    WorldState state = initial_state(world);
    std::vector<Item> things{
        {Item::kObject, 0}, {Item::kObject, 1}, {Item::kObject, 2}, {Item::kObject, 3}};
    if (i % 3 == 0) {
      Attachment held;
      held.link = 3;
      held.pose.translation = {1.6, 0, 0};
      state.attachments[4] = held;
    }
    const robot::Path path = random_path(random);
    const std::vector<Item> obstacles = find_obstacles(checker, state, 0, path, things, {});
    found += obstacles.size();
    // All that samples meet is among them; little else.
    const std::vector<Item> met = met_at_samples(checker, state, path);
    EXPECT_TRUE(std::includes(obstacles.begin(), obstacles.end(), met.begin(), met.end())) << i;
    beyond += obstacles.size() - met.size();
    // Each by itself, and whatever else is not there.
    std::vector<Item> alone;
    for (const Item& thing : things) {
      WorldState without = state;
      without.absent.assign(world.objects.size(), true);
      without.absent[thing.index] = without.absent[4] = false;
      for (const Item& one : find_obstacles(checker, without, 0, path, {thing}, {}))
        alone.push_back(one);
    }
    EXPECT_EQ(alone, obstacles) << i;
    // The path is free where it is without them, and none is in the way.
    WorldState bare = state;
    bare.absent = {true, true, true, true, false};
    const bool free_without =
        check_motion(checker, bare, 0, path, {}).outcome == MotionAnswer::Outcome::Free;
    EXPECT_EQ(check_motion(checker, state, 0, path, {}).outcome == MotionAnswer::Outcome::Free,
              free_without && obstacles.empty())
        << i;
    free += free_without && obstacles.empty() ? 1 : 0;
  }
  EXPECT_GT(found, 30U);
  EXPECT_GT(free, 20U);
  EXPECT_LT(beyond, 5U) << "passed by more closely than samples see";
  EXPECT_TRUE(find_obstacles(checker, initial_state(world), 0, {{0.5, 0, 0}}, {}, {}).empty());
  EXPECT_THROW(find_obstacles(checker, initial_state(world), 0, {}, {}, {}), Error);
}

TEST(Absent, RobotsAndWhatTheyCarryAreNotLookedAt) {
  const SceneFiles files;
  const std::string arm =
      R"({"name": "NAME", "urdf": )" + files.ref("arm.urdf") +
      R"(, "base": {"position": [0, Y, 0]}, "links": [{"link": "base", "outer": )" +
      files.ref("base.glb") + R"(}, {"link": "l1", "outer": )" + files.ref("l1.glb") +
      R"(}, {"link": "l2", "outer": )" + files.ref("l2.glb") + R"(}, {"link": "l3", "outer": )" +
      files.ref("l3.glb") + "}]}";
  const auto named = [&](const std::string& name, const std::string& y) {
    std::string out = arm;
    out.replace(out.find("NAME"), 4, name);
    return out.replace(out.find('Y'), 1, y);
  };
  const World world =
      files.world(R"({"kaboum_scene": 1, "unit": "m", "robots": [)" + named("a", "0") + ", " +
                  named("b", "1.5") + R"(], "objects": [{"name": "box", "outer": )" +
                  files.ref("box.glb") + "}]}");
  const Checker checker(world);
  Scratch scratch;
  WorldState state = initial_state(world);
  state.poses[0].translation = {0, 0, 9};
  state.q = {{1.5, 0, 0}, {-1.5, 0, 0}};  // towards each other
  EXPECT_FALSE(checker.is_free(state, scratch));
  state.absent_robots = {false, true};
  EXPECT_TRUE(checker.is_free(state, scratch));
  EXPECT_EQ(check_motion(checker, state, 0, {{1.5, 0, 0}, {1.4, 0, 0}}, {}).outcome,
            MotionAnswer::Outcome::Free);
  // What it carries is absent with it, or met.
  Attachment held;
  held.robot = 1;
  held.link = 3;
  state.attachments[0] = held;
  EXPECT_FALSE(checker.is_free(state, scratch));
  state.absent = {true};
  EXPECT_TRUE(checker.is_free(state, scratch));
  state.absent_robots = {false, false};
  EXPECT_FALSE(checker.is_free(state, scratch));
  state.absent_robots = {true};
  EXPECT_THROW(static_cast<void>(checker.is_free(state, scratch)), Error);
}

// Things that are put somewhere else while they are not looked at are found there afterwards.
TEST(Absent, ScratchFollowsWhatComesBack) {
  const SceneFiles files;
  const World world = boxes_scene(files);
  const Checker checker(world);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> turn(-3, 3), place(-3, 3);
  Scratch kept;
  std::size_t contacts = 0;
  WorldState state = initial_state(world);
  state.absent.assign(world.objects.size(), false);
  for (int i = 0; i < 400; ++i) {
    for (double& q : state.q[0]) q = turn(random);
    const std::size_t o = random() % world.objects.size();
    if (random() % 2 == 0) state.absent[o] = !state.absent[o];
    if (random() % 2 == 0) state.poses[o].translation = {place(random), place(random), 0};
    if (random() % 4 == 0) {
      if (state.attachments[o]) {
        state.attachments[o].reset();
      } else {
        Attachment held;
        held.link = 3;
        held.pose.translation = {1.6, 0, 0};
        state.attachments[o] = held;
      }
    }
    Scratch fresh;
    const bool free = checker.is_free(state, fresh);
    EXPECT_EQ(checker.is_free(state, kept), free) << i;
    contacts += free ? 0 : 1;
  }
  EXPECT_GT(contacts, 50U);
  EXPECT_LT(contacts, 350U);
}

}  // namespace
}  // namespace kaboum::world
