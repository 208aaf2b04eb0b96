// The checker against an oracle over sets of worlds, on small random tasks: on good and damaged
// plans, on plans that a planner with a mistake makes, and with a mistake of its own, which has to
// show.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>

#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "contingent_model.h"
#include "damaged_plan.h"
#include "mutants.h"
#include "possible_worlds.h"
#include "random_model.h"

int kaboum_mutant = 0;  ///< the mistake that is switched on; 0: none

namespace kaboum::plan::test {
namespace {

constexpr std::size_t kMostWorlds = 400;  // of all beliefs at the start: the oracle is slow

struct Task {
  std::string text;
  Model model;
  bool with_worlds;  ///< planner and checker may keep sets of worlds; else the databases decide
};

/// A random task of one of four kinds; nullopt: none that can be used.
std::optional<Task> task_of(std::uint32_t seed) {
  Task t;
  t.with_worlds = seed % 4 != 3;
  switch (seed % 4) {
    case 0:  // all updates and queries
      t.text = Generator(seed, false).model(4, 0);
      break;
    case 1:  // and disjunctions
      t.text = Generator(seed, true).model(4, 0);
      break;
    case 2:  // effects under conditions of the world
      t.text = ContingentGenerator(seed, true).model();
      break;
    default:  // the same, and an external function that nothing calls: nobody keeps worlds then
      t.text = ContingentGenerator(seed, true).model();
      t.text.insert(t.text.find("closed:"), "externals: never(v)\n");
  }
  const ExternalBindings bindings = {
      {"never", [](const Question&) { return Answer::not_found(""); }}};
  t.model = load({"t.kpl", t.text, Language::Kpl}, nullptr,
                 t.with_worlds ? ExternalBindings{} : bindings);
  std::size_t worlds = 0;
  for (const Belief& b : Worlds(t.model).initial()) {
    if (b.empty()) return std::nullopt;  // a contradiction
    worlds += b.size();
  }
  if (worlds == 0 || worlds > kMostWorlds) return std::nullopt;
  return t;
}

std::optional<Plan> plan_for(const Task& t, std::uint32_t seed) {
  SolveOptions o;
  o.algorithm = seed % 3 == 0 ? Algorithm::BreadthFirst : Algorithm::Greedy;
  o.timeout = 2;
  try {
    Solution s = solve(t.model, o);
    if (s.outcome == Outcome::Solved && s.plan.root != kNone) return std::move(s.plan);
  } catch (const Error&) {
    // With a mistake in it the planner may contradict itself.
  }
  return std::nullopt;
}

/// Without a mistake: nullopt where it gives up or finds a cycle.
std::optional<bool> verdict(const Task& t, const Plan& p) {
  try {
    return check(t.model, p).valid;
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool is_graph(const Task& t, const Plan& p) {
  try {
    measure(t.model, p);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// What the checker may say. Without worlds it may refute what works.
bool agrees(const Task& t, std::optional<bool> said, bool expected) {
  return said == expected || (!t.with_worlds && expected && said == false);
}

const std::vector<Task>& tasks() {
  static const auto* all = [] {
    auto* made = new std::vector<Task>;
    for (std::uint32_t seed = 0; made->size() < 2000; ++seed)
      if (auto t = task_of(seed)) made->push_back(std::move(*t));
    return made;
  }();
  return *all;
}

struct Case {
  const Task* task;
  Plan plan;
  bool works;  ///< as the oracle has it
};

/// Plans of the planner, and the same with damage.
std::vector<Case> cases(std::size_t most) {
  std::vector<Case> out;
  std::mt19937 random(7);
  for (std::uint32_t i = 0; i < tasks().size() && out.size() < most; ++i) {
    const Task& t = tasks()[i];
    const auto plan = plan_for(t, i);
    if (!plan) continue;
    for (int n = 0; n < 6; ++n) {
      Plan p = n == 0 ? *plan : damaged(t.model, *plan, 1 + random() % 2, random);
      if (!is_graph(t, p)) continue;
      const bool works = valid_in_worlds(t.model, p);
      EXPECT_TRUE(works || n > 0) << t.text << plan_text(t.model, p);
      out.push_back({&t, std::move(p), works});
    }
  }
  return out;
}

TEST(Checker, SaysWhatSetsOfWorldsSay) {
  int works = 0, fails = 0, refuted_though_it_works = 0;
  for (const Case& c : cases(6000)) {
    const auto said = verdict(*c.task, c.plan);
    EXPECT_TRUE(agrees(*c.task, said, c.works))
        << c.task->text << plan_text(c.task->model, c.plan) << "works: " << c.works;
    ++(c.works ? works : fails);
    refuted_though_it_works += said == false && c.works ? 1 : 0;
  }
  EXPECT_GT(works, 1000);
  EXPECT_GT(fails, 1000);
  EXPECT_LT(refuted_though_it_works, works / 10);
  RecordProperty("works", works);
  RecordProperty("fails", fails);
  RecordProperty("refuted_though_it_works", refuted_though_it_works);
}

/// Each mistake of the planner leads to wrong plans, and all of these are refuted.
TEST(Checker, RefutesWhatAPlannerWithAMistakeMakes) {
  int planners = 0;
  for (const Mutant& m : kMutants) {
    if (std::strcmp(m.part, "check") == 0) continue;
    ++planners;
    int wrong = 0;
    for (std::uint32_t i = 0; i < tasks().size() && wrong < 2; ++i) {
      const Task& t = tasks()[i];
      kaboum_mutant = m.number;
      const auto plan = plan_for(t, i);
      kaboum_mutant = 0;
      if (!plan) continue;
      const auto said = verdict(t, *plan);
      if (said == true && !is_graph(t, *plan)) ADD_FAILURE() << "a cycle is valid";
      const bool works = valid_in_worlds(t.model, *plan);
      EXPECT_TRUE(agrees(t, said, works)) << m.name << "\n" << t.text << plan_text(t.model, *plan);
      wrong += works ? 0 : 1;
    }
    EXPECT_GT(wrong, 0) << "no wrong plan: " << m.part << ": " << m.name;
  }
  EXPECT_GE(planners, 40);
}

/// A mistake of the checker shows in some verdict.
TEST(Checker, NoMistakeOfItsOwnGoesUnseen) {
  const std::vector<Case> all = cases(6000);
  int checkers = 0;
  for (const Mutant& m : kMutants) {
    if (std::strcmp(m.part, "check") != 0) continue;
    ++checkers;
    bool seen = false;
    for (const Case& c : all) {
      kaboum_mutant = m.number;
      const auto said = verdict(*c.task, c.plan);
      kaboum_mutant = 0;
      seen = !agrees(*c.task, said, c.works);
      if (seen) break;
    }
    EXPECT_TRUE(seen) << m.name;
  }
  EXPECT_GE(checkers, 40);
}

}  // namespace
}  // namespace kaboum::plan::test
