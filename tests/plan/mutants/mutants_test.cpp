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

constexpr int kVariants = 16;             // of a plan: as it is, and damaged
constexpr std::size_t kMostWorlds = 400;  // of all beliefs at the start: the oracle is slow

struct Task {
  std::string text;
  Model model;
  bool with_worlds;  ///< planner and checker may keep sets of worlds; else the databases decide
};

Task load_task(const std::string& text, bool with_worlds) {
  const ExternalBindings bindings = {
      {"never", [](const Question&) { return Answer::not_found(""); }}};
  return {
      text,
      load({"t.kpl", text, Language::Kpl}, nullptr, with_worlds ? ExternalBindings{} : bindings),
      with_worlds};
}

/// A small task that one mistake shows in, and a plan that the checker has to judge.
struct Probe {
  const char* what;
  bool with_worlds;
  const char* text;  ///< from the initial state on
  const char* nodes;
  bool works;
};

const char* const kAct = R"({"action":"act","arguments":[],"next":"goal"})";
const char* const kActAndLook = R"({"action":"act","arguments":[],"next":1},
                                   {"action":"look","arguments":[],"next":"goal"})";

const char* const kTwoWays =
    R"({"action":"look","arguments":[],"branch":{"predicate":"s","arguments":[],
        "cases":[{"value":true,"next":1},{"value":false,"next":2}]}},
       {"action":"one","arguments":[],"next":3},{"action":"two","arguments":[],"next":3},
       {"action":"act","arguments":[],"next":"goal"})";

const Probe kProbes[] = {
    {"an effect may happen", false,
     "init: K(!q)\naction act effects: add(Kf, done), whenever K(p) => { add(Kf, q) }\n"
     "goal: K(done) & K(!q)",
     kAct, false},
    {"a deletion may happen", false,
     "init: K(q)\naction act effects: add(Kf, done), whenever K(p) => { del(Kf, q) }\n"
     "goal: K(done) & K(q)",
     kAct, false},
    {"an atom of Or is not closed", false,
     "init: Or(p | q), LCW(p)\naction act effects: add(Kf, done)\ngoal: K(done) & K(!p)", kAct,
     false},
    {"what is deleted is not known", false,
     "init: K(q)\naction act effects: add(Kf, done), del(Kf, q)\ngoal: K(done) & K(q)", kAct,
     false},
    {"both atoms of Or may hold", true,
     "init: Or(p | q), K(!r)\n"
     "action act effects: add(Kf, done), whenever K(p) & K(q) => { add(Kf, r) }\n"
     "goal: K(done) & K(!r)",
     kAct, false},
    {"a step further down fails", true,
     "init: Or(p | q), K(!m), K(!go), K(!x), K(!done), K(!r)\n"
     "action look effects: add(Kw, s)\n"
     "action one preconds: K(s) effects: add(Kf, m), add(Kf, go)\n"
     "action two preconds: K(!s) effects: add(Kf, go)\n"
     "action prepare preconds: K(go) effects: add(Kf, x)\n"
     "action end_one preconds: K(x) & K(m) effects: add(Kf, done), "
     "whenever K(p) => { add(Kf, r) }, whenever K(q) => { add(Kf, r) }\n"
     "action end_two preconds: K(x) & K(!m) effects: add(Kf, done), "
     "whenever K(p) => { add(Kf, r) }, whenever K(q) => { add(Kf, r) }\n"
     "goal: K(done) & K(r)",
     R"({"action":"look","arguments":[],"branch":{"predicate":"s","arguments":[],
         "cases":[{"value":true,"next":1},{"value":false,"next":2}]}},
        {"action":"one","arguments":[],"next":3},{"action":"two","arguments":[],"next":3},
        {"action":"prepare","arguments":[],"next":4},
        {"action":"end_two","arguments":[],"next":"goal"})",
     false},
    {"what is deleted hangs on what is sensed later", true,
     "init: K(q)\naction act effects: whenever K(p) => { del(Kf, q) }\n"
     "action look effects: add(Kw, p)\naction fix effects: add(Kf, q)\ngoal: Kw(p) & K(q)",
     R"({"action":"act","arguments":[],"next":1},
        {"action":"look","arguments":[],"branch":{"predicate":"p","arguments":[],
         "cases":[{"value":true,"next":2},{"value":false,"next":"goal"}]}},
        {"action":"fix","arguments":[],"next":"goal"})",
     true},
    {"one of two effects happens", true,
     "init: K(!r)\naction act effects: whenever K(p) => { add(Kf, r) }\n"
     "action look effects: whenever K(!p) => { add(Kf, r) }\ngoal: K(r)",
     kActAndLook, true},
    {"an atom that changes tells nothing of the others", false,
     "init: Kx(p | q)\naction act effects: add(Kf, !p), add(Kf, done)\n"
     "action look effects: add(Kw, u)\ngoal: K(done) & K(q)",
     R"({"action":"act","arguments":[],"next":1},
        {"action":"look","arguments":[],"branch":{"predicate":"u","arguments":[],
         "cases":[{"value":true,"next":"goal"},{"value":false,"next":"goal"}]}})",
     false},
    {"half of a condition is known to hold", false,
     "init: K(p), K(!r)\naction act effects: whenever K(p) & K(u) => { add(Kf, r) }\ngoal: K(r)",
     kAct, false},
    {"half of a condition is known to fail", false,
     "init: K(!p), K(!r)\n"
     "action act effects: add(Kf, done), whenever K(p) | K(u) => { add(Kf, r) }\n"
     "goal: K(done) & K(!r)",
     kAct, false},
    {"a branch on what is not known", false,
     "init: K(!r)\naction act effects: add(Kf, done)\ngoal: K(done)",
     R"({"branch":{"predicate":"p","arguments":[],
         "cases":[{"value":true,"next":1},{"value":false,"next":1}]}},
        {"action":"act","arguments":[],"next":"goal"})",
     false},
    {"a condition that holds may fail further down", false,
     "init: K(!p), K(!q)\naction look effects: add(Kw, s)\n"
     "action one preconds: K(s) effects: add(Kf, q)\n"
     "action two preconds: K(!s) effects: add(Kf, p)\n"
     "action act effects: add(Kf, done), add(Kf, !p)\ngoal: K(done) & (K(p) | K(q))",
     kTwoWays, false},
    {"a condition of what is unknown does not hold", false,
     "init: K(!u)\naction look effects: add(Kw, s)\n"
     "action one preconds: K(s) effects: add(Kf, q)\n"
     "action two preconds: K(!s) effects: add(Kf, u)\n"
     "action act effects: add(Kf, done)\ngoal: K(done) & (K(p) | K(q))",
     kTwoWays, false},
    {"an observation that contradicts what is known", false,
     "init: K(!p), K(!q)\naction act effects: add(Kf, done), add(Kx, p | q)\ngoal: K(done)", kAct,
     false},
};

Task task_of(const Probe& p) {
  const std::string external = p.with_worlds ? "" : "externals: never(v)\n";
  return load_task("types: v\nconstants: v a\npredicates: p, q, r, s, u, m, x, go, done\n" +
                       external + p.text + "\n",
                   p.with_worlds);
}

Plan plan_of(const Probe& p, const Task& t) {
  return read_plan(
      t.model,
      std::string(R"({"format":"kaboum-plan","version":1,"root":0,"nodes":[)") + p.nodes + "]}",
      "plan.json");
}

/// A random task of one of four kinds; nullopt: none that can be used.
std::optional<Task> task_of(std::uint32_t seed) {
  const bool with_worlds = seed % 4 != 3;
  std::string text;
  switch (seed % 4) {
    case 0:  // all updates and queries
      text = Generator(seed, false).model(4, 0);
      break;
    case 1:  // and disjunctions
      text = Generator(seed, true).model(4, 0);
      break;
    case 2:  // effects under conditions of the world
      text = ContingentGenerator(seed, true).model();
      break;
    default:  // the same, and an external function that nothing calls: nobody keeps worlds then
      text = ContingentGenerator(seed, true).model();
      text.insert(text.find("closed:"), "externals: never(v)\n");
  }
  Task t = load_task(text, with_worlds);
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
    for (const Probe& p : kProbes) made->push_back(task_of(p));
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
  for (std::size_t i = 0; i < std::size(kProbes); ++i) {
    const Task& t = tasks()[i];
    out.push_back({&t, plan_of(kProbes[i], t), kProbes[i].works});
    EXPECT_EQ(valid_in_worlds(t.model, out.back().plan), kProbes[i].works) << kProbes[i].what;
  }
  std::mt19937 random(7);
  for (std::uint32_t i = 0; i < tasks().size() && out.size() < most; ++i) {
    const Task& t = tasks()[i];
    const auto plan = plan_for(t, i);
    if (!plan) continue;
    for (int n = 0; n < kVariants; ++n) {
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
  EXPECT_GT(fails, 600);
  EXPECT_LT(refuted_though_it_works, works / 10);
  RecordProperty("works", works);
  RecordProperty("fails", fails);
  RecordProperty("refuted_though_it_works", refuted_though_it_works);
}

/// Each mistake of the planner leads to a wrong plan, which is refuted; what it plans before that
/// is judged as the oracle has it.
TEST(Checker, RefutesWhatAPlannerWithAMistakeMakes) {
  int planners = 0;
  for (const Mutant& m : kMutants) {
    if (std::strcmp(m.part, "check") == 0) continue;
    ++planners;
    int wrong = 0;
    for (std::uint32_t i = 0; i < tasks().size() && wrong == 0; ++i) {
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
  EXPECT_GE(planners, 46);
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
  EXPECT_GE(checkers, 47);
}

}  // namespace
}  // namespace kaboum::plan::test
