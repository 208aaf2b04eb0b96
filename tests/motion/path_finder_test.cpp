// Paths query after query, and roadmaps: certified as find_path's are, the same on any processor.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/motion/roadmap.h>
#include <kaboum/motion/trajectory.h>

#include <atomic>
#include <optional>
#include <random>
#include <set>
#include <thread>

#include "random_scene.h"
#include "world/worlds.h"

namespace kaboum::motion {
namespace {

using test::random_scene;
using test::RandomScene;
using test::SceneFiles;
using Outcome = PathAnswer::Outcome;
using Values = std::vector<double>;

struct Query {
  Values start, goal;
};

std::vector<Query> random_queries(const world::Checker& checker, std::size_t count,
                                  std::uint64_t seed) {
  std::mt19937_64 random(seed);
  world::WorldState state = initial_state(checker.world());
  world::Scratch scratch;
  std::vector<Query> out(count);
  for (Query& query : out)
    for (Values* end : {&query.start, &query.goal}) {
      do state.q[0] = test::random_values(checker.world().robots[0].kinematics, random);
      while (checker.find_contact(state, scratch));
      *end = state.q[0];
    }
  return out;
}

std::optional<std::string> meeting_on(const robot::Path& path, const test::ExactScene& exact) {
  const std::size_t count = path.front().size();
  const Trajectory trajectory(path, {Values(count, 4), Values(count, 30)}, 1000);
  for (std::size_t k = 0; k < trajectory.samples(); ++k)
    if (auto contact = exact.find_contact(trajectory.sample(k))) return contact;
  return std::nullopt;
}

/// What is claimed of a path, decided by others.
void expect_certified(const PathAnswer& answer, const Query& query, const world::Checker& checker,
                      const RandomScene& scene) {
  ASSERT_EQ(answer.outcome, Outcome::Found);
  EXPECT_EQ(answer.path.front(), query.start);
  EXPECT_EQ(answer.path.back(), query.goal);
  EXPECT_EQ(check_motion(checker, initial_state(checker.world()), 0, answer.path, {}).outcome,
            world::MotionAnswer::Outcome::Free);
  EXPECT_FALSE(meeting_on(answer.path, scene.exact));
}

TEST(PathFinder, PathsAreCertifiedAndTheSameForAllInstructionsAndThreads) {
  std::size_t round = 0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    const RandomScene scene = random_scene(seed, 14);
    const world::Checker checker(scene.world);
    const std::vector<Query> queries = random_queries(checker, 6, seed);
    const PathFinder finder(checker, initial_state(scene.world), 0);
    const PathOptions options{.most_work = 0.2};
    std::vector<PathAnswer> answers;
    for (const Query& query : queries) {
      answers.push_back(finder.find(query.start, {{query.goal}}, options));
      if (answers.back().outcome != Outcome::Found) continue;
      expect_certified(answers.back(), query, checker, scene);
      round += answers.back().straight ? 0 : 1;
    }
    for (const filter::Instructions set : filter::instruction_sets()) {
      const PathFinder other(checker, initial_state(scene.world), 0, {.instructions = set});
      // The other way round, so that what was asked before differs.
      for (std::size_t i = queries.size(); i-- > 0;) {
        const PathAnswer answer = other.find(queries[i].start, {{queries[i].goal}}, options);
        EXPECT_EQ(answer.outcome, answers[i].outcome) << name_of(set);
        EXPECT_EQ(answer.path, answers[i].path) << name_of(set);
        EXPECT_EQ(answer.spent.work, answers[i].spent.work) << name_of(set);
      }
    }
    std::atomic<std::size_t> differ = 0;
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t)
      threads.emplace_back([&] {
        for (std::size_t i = 0; i < queries.size(); ++i)
          if (finder.find(queries[i].start, {{queries[i].goal}}, options).path != answers[i].path)
            ++differ;
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(differ, 0U);
  }
  EXPECT_GT(round, 12U);
}

class BetweenBoxes : public ::testing::Test {
 protected:
  BetweenBoxes() {
    files_.put(
        "plate.glb",
        test::set_of({test::box_mesh({-0.25, -0x1p-13, -0.5}, {0.25, 0x1p-13, 0.5})}, "outer", 0));
  }
  [[nodiscard]] world::World plate_at(double x) const {
    return files_.world(
        files_.scene("\"objects\": [{\"name\": \"plate\", \"pose\": {\"position\": [" +
                     std::to_string(x) + ", 0, 0]}, \"outer\": " + files_.ref("plate.glb") + "}]"));
  }
  SceneFiles files_;
};

TEST_F(BetweenBoxes, SearchesWithoutAPathEndWithTheirLimits) {
  std::string objects;
  for (const char* at : {"[0, 1, 0]", "[0, -1, 0]"})
    objects += std::string(objects.empty() ? "" : ",") + "{\"name\": \"o" +
               std::to_string(objects.size()) + "\", \"pose\": {\"position\": " + at +
               "}, \"outer\": " + files_.ref("box.glb") + "}";
  const world::World world = files_.world(files_.scene("\"objects\": [" + objects + "]"));
  const world::Checker checker(world);
  const PathFinder finder(checker, initial_state(world), 0);
  const Roadmap roadmap(finder, {.nodes = 100});
  const std::vector<Values> goals{{3, 0, 0}};
  for (const double work : {0.001, 0.1}) {
    const PathAnswer by_trees = finder.find({0, 0, 0}, goals, {.most_work = work}),
                     by_roadmap = roadmap.find(finder, {0, 0, 0}, goals, {.most_work = work});
    for (const PathAnswer& answer : {by_trees, by_roadmap}) {
      EXPECT_EQ(answer.outcome, Outcome::WorkEnded);
      EXPECT_TRUE(answer.path.empty());
      EXPECT_FALSE(answer.blockers.empty());
      EXPECT_GE(answer.spent.work, work);
      EXPECT_LT(answer.spent.work, work + 0.01);  // one step more
    }
  }
  EXPECT_EQ(finder.find({0, 0, 0}, goals, {.most_nodes = 1}).outcome, Outcome::NodesEnded);
  EXPECT_EQ(finder.find({0, 0, 0}, goals, {.most_seconds = 1e-9}).outcome, Outcome::TimeEnded);
}

TEST_F(BetweenBoxes, WhatIsCarriedMustPassToo) {
  const world::World world = files_.world(files_.scene(
      "\"objects\": [{\"name\": \"plate\", \"pose\": {\"position\": [2.7, 0, 0]}, \"outer\": " +
      files_.ref("plate.glb") + "}, {\"name\": \"block\", \"outer\": " + files_.ref("box.glb") +
      "}]"));
  const world::Checker checker(world);
  world::WorldState state = initial_state(world);
  world::Attachment held;
  held.link = 1;
  held.pose.translation = {2.6, 0, 0};
  state.attachments[1] = held;
  const PathFinder finder(checker, state, 0);
  const std::vector<Values> goals{{0.6, 1.5, 1.5}};
  const PathOptions options{.most_work = 0.2};
  const PathAnswer answer = finder.find({-0.6, 1.5, 1.5}, goals, options),
                   other = find_path(checker, state, 0, {-0.6, 1.5, 1.5}, goals, options);
  EXPECT_EQ(answer.path, other.path);  // decided without vector code
}

TEST(Roadmap, PathsAreCertifiedAlsoByOneThatLies) {
  std::size_t round = 0, shorter_work = 0;
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    const RandomScene scene = random_scene(seed, 14);
    const world::Checker checker(scene.world);
    const PathFinder finder(checker, initial_state(scene.world), 0);
    const Roadmap roadmap(finder, {.nodes = 300});
    EXPECT_EQ(roadmap.nodes(), 300U);
    EXPECT_GT(roadmap.edges(), 300U);
    const Roadmap read = Roadmap::from_json(roadmap.to_json(), "map", finder);
    EXPECT_EQ(read.to_json(), roadmap.to_json());
    // Every node joined to the ten that follow it, whatever is in the way.
    std::string lies = roadmap.to_json();
    std::string edges;
    for (std::size_t i = 0; i < 300; ++i)
      for (std::size_t k = i + 1; k < std::min<std::size_t>(300, i + 11); ++k)
        edges += (edges.empty() ? "[" : ",[") + std::to_string(i) + "," + std::to_string(k) + "]";
    const std::size_t begin = lies.find("\"edges\":[") + 9, end = lies.find("]]", begin) + 1;
    lies.replace(begin, end - begin, edges);
    const Roadmap liar = Roadmap::from_json(lies, "lies", finder);
    EXPECT_GT(liar.edges(), 2000U);
    for (const Query& query : random_queries(checker, 6, seed + 100)) {
      const PathOptions options{.most_work = 0.5};
      const PathAnswer answer = roadmap.find(finder, query.start, {{query.goal}}, options);
      EXPECT_EQ(read.find(finder, query.start, {{query.goal}}, options).path, answer.path);
      const PathAnswer of_liar = liar.find(finder, query.start, {{query.goal}}, options);
      if (of_liar.outcome == Outcome::Found) expect_certified(of_liar, query, checker, scene);
      if (answer.outcome != Outcome::Found) continue;
      expect_certified(answer, query, checker, scene);
      if (answer.straight) continue;
      ++round;
      const PathAnswer by_trees = finder.find(query.start, {{query.goal}}, options);
      shorter_work += by_trees.spent.samples > 0 && answer.spent.samples == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(round, 8U);
  EXPECT_GT(shorter_work, round / 2);  // by the roadmap alone, without trees
}

TEST_F(BetweenBoxes, ARoadmapThatLeavesTheLimitsIsRefused) {
  const world::World world = plate_at(2.7);
  const world::Checker checker(world);
  const PathFinder finder(checker, initial_state(world), 0);
  const std::string map = Roadmap(finder, {.nodes = 50}).to_json();
  const std::size_t begin = map.find("\"nodes\":[") + 9, end = map.find("]]", begin) + 1;
  for (const char* nodes :
       {"[-3.3,0,-1],[-3.3,0,2.5]", "[0,0,1e10],[0,0,1]", "[0,0,1],[-3e10,0,0]"}) {
    std::string lies = map;
    lies.replace(begin, end - begin, nodes);
    lies.replace(lies.find("\"edges\":["), std::string::npos, "\"edges\":[[0,1]]}");
    EXPECT_THROW(Roadmap::from_json(lies, "lies", finder), Error) << nodes;
  }
  PathOptions options;
  for (const double resolution : {0.0, -0.1}) {
    options.check.resolution = resolution;
    const std::vector<Values> goals{{0.5, 0, 0}};
    EXPECT_THROW(finder.find({-0.5, 0, 0}, goals, options), Error);
  }
}

TEST(Roadmap, IsTheSameForAllInstructions) {
  const RandomScene scene = random_scene(3, 14);
  const world::Checker checker(scene.world);
  std::set<std::string> made;
  for (const filter::Instructions set : filter::instruction_sets()) {
    const PathFinder finder(checker, initial_state(scene.world), 0, {.instructions = set});
    made.insert(Roadmap(finder, {.nodes = 200}).to_json());
  }
  EXPECT_EQ(made.size(), 1U);
}

TEST_F(BetweenBoxes, ARoadmapOfAnotherSceneIsRefused) {
  const world::World world = plate_at(2.7), moved = plate_at(2.70001);
  const world::Checker checker(world), other(moved);
  const PathFinder finder(checker, initial_state(world), 0),
      elsewhere(other, initial_state(moved), 0);
  const Roadmap roadmap(finder, {.nodes = 50});
  const std::vector<Values> goals{{0.5, 0, 0}};
  EXPECT_EQ(roadmap.find(finder, {-0.5, 0, 0}, goals, {}).outcome, Outcome::Found);
  EXPECT_THROW(roadmap.find(elsewhere, {-0.5, 0, 0}, goals, {}), Error);
  EXPECT_THROW(Roadmap::from_json(roadmap.to_json(), "map", elsewhere), Error);
  world::World farther = plate_at(2.7);
  farther.margins.all = 0.01;
  const world::Checker with_margin(farther);
  EXPECT_THROW(
      roadmap.find(PathFinder(with_margin, initial_state(farther), 0), {-0.5, 0, 0}, goals, {}),
      Error);
  world::WorldState state = initial_state(world);
  state.poses[0].translation = {2.6, 0, 0};
  EXPECT_THROW(roadmap.find(PathFinder(checker, state, 0), {-0.5, 0, 0}, goals, {}), Error);
  // A state in which only the robot itself is elsewhere is the same one.
  state = initial_state(world);
  state.q[0] = {0.3, 0.2, 0.1};
  EXPECT_EQ(roadmap.find(PathFinder(checker, state, 0), {-0.5, 0, 0}, goals, {}).outcome,
            Outcome::Found);
  for (const char* text : {"", "[]", "{}", R"({"roadmap": 2})", R"({"roadmap": 1, "scene": "x"})"})
    EXPECT_THROW(Roadmap::from_json(text, "map", finder), Error) << text;
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"\"nodes\":[[", "\"nodes\":[[1,"},
                                                        {"\"edges\":[[", "\"edges\":[[50,0],["},
                                                        {"\"edges\":[[", "\"edges\":[[-1,0],["},
                                                        {"\"edges\":[[", "\"edges\":[[1,1],["},
                                                        {"\"edges\":[[", "\"edges\":[[1,2,3],["},
                                                        {"\"edges\":", "\"edge\":"},
                                                        {"{", "{\"roadmap\":1,"}}) {
    std::string text = roadmap.to_json();
    text.replace(text.find(from), from.size(), to);
    EXPECT_THROW(Roadmap::from_json(text, "map", finder), Error) << to;
  }
  EXPECT_THROW(Roadmap(finder, {.nodes = 0}), Error);
}

}  // namespace
}  // namespace kaboum::motion
