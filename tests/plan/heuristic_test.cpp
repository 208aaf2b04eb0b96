// Every estimate in every reachable state of random tasks against the exact cost to the goal; and
// the invariants against every reachable state.
#include <deque>
#include <map>
#include <random>
#include <set>

#include "goal_target.h"
#include "plan_test.h"
#include "search/applicable_steps.h"
#include "search/engine.h"
#include "search/invariants.h"
#include "search/landmarks.h"
#include "search/radix_queue.h"
#include "search/relaxed_plan.h"
#include "search/search.h"
#include "search/state_store.h"

namespace kaboum::plan::test {
namespace {

/// Mostly classical: objects that move between places, one action at a time, with updates of all
/// kinds on what is known; some with sensing.
std::string random_task(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const bool sensing = pick(4) == 0;
  std::string text =
      "types: box, place\nconstants: box x, y; place a, b, c\n"
      "predicates: at(box, place), clear(place), on, off\nfunctions: in(box) : place\ninit:\n";
  const auto box = [&] { return std::string(pick(2) ? "x" : "y"); };
  const auto place = [&] { return std::string(1, "abc"[pick(3)]); };
  for (const char* b : {"x", "y"})
    for (const char* p : {"a", "b", "c"})
      if (pick(3))
        text += std::string("  K(") + (pick(2) ? "!" : "") + "at(" + b + ", " + p + "))\n";
  for (const char* p : {"a", "b", "c"})
    if (pick(3)) text += std::string("  K(") + (pick(2) ? "!" : "") + "clear(" + p + "))\n";
  text += "  K(in(x) = " + place() + ")\n";
  if (pick(2)) text += "  K(in(y) = " + place() + ")\n";
  std::string b, p;  // of the action at hand
  const auto any_box = [&] { return pick(3) ? b : box(); };
  const auto any_place = [&] { return pick(3) ? p : place(); };
  const auto literal = [&](bool positive) -> std::string {
    const std::string sign = !positive && pick(2) ? "!" : "";
    switch (pick(6)) {
      case 0:
      case 1:
        return sign + "at(" + any_box() + ", " + any_place() + ")";
      case 2:
        return sign + "clear(" + any_place() + ")";
      case 3:
        return sign + (pick(2) ? "on" : "off");
      default:
        return "in(" + any_box() + ") = " + any_place();
    }
  };
  const auto update = [&]() -> std::string {
    switch (pick(sensing ? 9 : 7)) {
      case 0:
        return "del(Kf, " + literal(false) + ")";
      case 1:
        return "maybe(Kf, " + literal(false) + ")";
      case 7:
        return "add(Kw, at(" + any_box() + ", " + any_place() + "))";
      case 8:
        return "add(Kv, in(" + any_box() + "))";
      default:
        return "add(Kf, " + literal(false) + ")";
    }
  };
  const std::size_t actions = 3 + pick(4);
  for (std::size_t i = 0; i < actions; ++i) {
    b = pick(2) ? "?b" : "x";
    p = pick(2) ? "?p" : "a";
    text += "action act" + std::to_string(i) + "(?b : box, ?p : place)\n  preconds: K(" +
            literal(false) + ")" + (pick(2) ? " & K(" + literal(false) + ")" : "") +
            (pick(4) == 0 ? " & !K(" + literal(false) + ")" : "") + "\n  effects: " + update() +
            ", " + update();
    if (pick(2)) text += ", K(" + literal(false) + ") => " + update();
    if (pick(3) == 0) text += ", forall(?q : place) (K(at(" + b + ", ?q)) => add(Kf, clear(?q)))";
    text += "\n  cost: " + std::to_string(pick(4)) + "\n";
  }
  b = box();
  p = place();
  return text + "goal: K(" + literal(true) + ") & K(" + literal(true) + ") & K(" + literal(true) +
         ")\n";
}

TEST(RadixQueue, TakesKeysInOrder) {
  std::mt19937 random(1);
  RadixQueue queue;
  for (int round = 0; round < 20; ++round) {
    std::multiset<RadixQueue::Key> reference;
    queue.clear();
    const auto push = [&](RadixQueue::Key key) {
      queue.push(key, key ^ 1U);
      reference.insert(key);
    };
    for (int i = 0; i < 50; ++i) push(random() % 100);
    for (int i = 0; i < 2000 && !reference.empty(); ++i) {
      const auto [key, item] = queue.pop();
      EXPECT_EQ(key, *reference.begin());
      EXPECT_EQ(item, key ^ 1U);
      reference.erase(reference.begin());
      if (i < 1500) push(key + (random() % 3 == 0 ? random() % (1U << 20U) : random() % 4));
    }
    EXPECT_EQ(queue.empty(), reference.empty());
  }
}

TEST(Estimates, SensingTellsNothingOfWhatIsKnown) {
  const auto start = [](const std::string& init) {
    const Model m =
        model_of("predicates: p\naction look effects: add(Kw, p)\ninit: " + init + "\ngoal: K(!p)");
    const Solution s = solved(m, Algorithm::Greedy);
    EXPECT_EQ(s.outcome, Outcome::Unsolvable);
    return s.statistics.initial_estimate;
  };
  EXPECT_EQ(start("K(p)"), std::nullopt) << "a dead end, without a look at any state";
  EXPECT_EQ(start(""), 1) << "it may be sensed that p is false";
  // What the action itself makes unknown it may sense.
  const Model m = model_of(
      "predicates: p, q\naction toss effects: del(Kf, p), add(Kw, p), add(Kf, q)\ninit: K(p), "
      "K(!q)\ngoal: K(q) & Kw(p)");
  EXPECT_EQ(solved(m, Algorithm::Greedy).outcome, Outcome::Solved);
}

TEST(Estimates, TheRelaxedPlanCountsStepsWhateverTheyCost) {
  const Model m = model_of(
      "predicates: p, q\ninit: K(!p) K(!q)\naction one preconds: K(!p) effects: add(Kf, p)\n  "
      "cost: "
      "100\naction two preconds: K(p) effects: add(Kf, q)\n  cost: 0\ngoal: K(q)");
  EXPECT_EQ(solved(m, Algorithm::Greedy).statistics.initial_estimate, 2);
}

/// Its steps, made one after the other, lead to the goal.
bool has_plan_by_width(Task& task, Limits& limits, Statistics& statistics, Heuristics& heuristics) {
  GoalTarget goal(task);
  if (goal.reached(task.initial().data())) return true;
  const auto engine = width_engine({task, task.initial(), goal, limits, statistics, heuristics});
  std::optional<SearchResult> found;
  while (!found) found = engine->advance(10'000, 0);
  if (found->outcome != Outcome::Solved) return false;
  Knowledge state(task.layout());
  state.assign(task.initial().data());
  for (const OperatorId step : found->steps) {
    EXPECT_TRUE(task.evaluator().holds(task.action(step).precondition, state.words()));
    EXPECT_TRUE(task.apply(step, state));
  }
  EXPECT_TRUE(goal.reached(state.words()));
  return true;
}

TEST(Estimates, AreSafeAndAdmissibleInEveryReachableState) {
  int tasks = 0;
  std::uint64_t states = 0;
  std::uint64_t positive = 0;
  std::uint64_t dead = 0;
  std::uint64_t exclusive_pairs = 0;
  std::uint64_t applicable = 0;
  std::uint64_t by_width = 0;
  for (std::uint32_t seed = 0; seed < 5000 && !HasFailure(); ++seed) {
    const std::string text = random_task(seed);
    const Model model = model_of(text);
    const SolveOptions options;
    Statistics statistics;
    Limits limits(options, statistics);
    Task task(model, limits);
    task.branch(Task::Branching::Anywhere);
    const Index words = task.layout().words();
    StateStore store(words);
    Knowledge scratch(task.layout());
    struct Edge {
      Index from;
      std::int64_t cost;
    };
    std::vector<std::vector<Edge>> into;
    std::vector<OperatorId> steps;
    store.insert(task.initial().data(), Knowledge::hash_of(task.initial().data(), words), 0, 0);
    into.resize(1);
    bool too_many = false;
    for (Index i = 0; i < store.size() && !too_many; ++i) {
      task.expand(store[i], steps);
      for (const OperatorId s : steps) {
        scratch.assign(store[i]);
        if (!task.apply(s, scratch)) continue;
        const auto [n, fresh] = store.insert(scratch.words(), scratch.hash(), i, s);
        if (fresh) into.emplace_back();
        into[n].push_back({i, task.cost(s)});
      }
      too_many = store.size() > 1500;
    }
    if (too_many) continue;
    ++tasks;
    // Exact cost of the cheapest way to the goal (of a weak plan, if there is sensing).
    constexpr std::int64_t kFar = 1'000'000;
    std::vector<std::int64_t> exact(store.size(), kFar);
    std::multimap<std::int64_t, Index> queue;
    for (Index i = 0; i < store.size(); ++i)
      if (task.evaluator().holds(task.goal(), store[i])) {
        exact[i] = 0;
        queue.emplace(0, i);
      }
    while (!queue.empty()) {
      const auto [d, i] = *queue.begin();
      queue.erase(queue.begin());
      if (d != exact[i]) continue;
      for (const Edge& e : into[i])
        if (d + e.cost < exact[e.from]) {
          exact[e.from] = d + e.cost;
          queue.emplace(d + e.cost, e.from);
        }
    }
    Heuristics heuristics;
    LandmarkHeuristic& landmarks = heuristics.landmark(task, limits);
    RelaxedPlan& relaxed = heuristics.relaxed(task, limits);
    const FactTable& facts = heuristics.relaxation->facts();
    for (Index i = 0; i < store.size() && !HasFailure(); ++i) {
      ++states;
      const auto h = landmarks.evaluate(store[i]);
      if (h) {
        EXPECT_LE(static_cast<std::int64_t>(*h), exact[i]) << "seed " << seed << "\n" << text;
        positive += *h > 0 && exact[i] < kFar ? 1 : 0;
      } else {
        EXPECT_EQ(exact[i], kFar) << "seed " << seed << "\n" << text;
        ++dead;
      }
      EXPECT_TRUE(landmarks.count(store[i]) || exact[i] == kFar) << "seed " << seed << "\n" << text;
      if (!task.layout().sensing()) {
        // The same by the facts that ground steps need as by descent over parameters.
        std::vector<OperatorId> found;
        task.expand_unasked(store[i], steps);
        heuristics.steps(task, limits).find(store[i], found);
        EXPECT_EQ(found, steps) << "seed " << seed << "\n" << text;
        applicable += found.size();
      }
      if (relaxed.evaluate(store[i]) == RelaxedPlan::kDeadEnd) {
        EXPECT_EQ(exact[i], kFar) << "seed " << seed << "\n" << text;
        ++dead;
      }
      std::vector<FactId> now;
      for (Index f = 0; f < task.layout().fluents().size(); ++f)
        now.push_back(facts.fact(f, task.layout().fluents()[f].get(store[i])));
      for (std::size_t k = 0; k < now.size(); ++k)
        for (std::size_t l = k + 1; l < now.size(); ++l)
          EXPECT_FALSE(heuristics.invariants->exclusive(now[k], now[l])) << "seed " << seed << "\n"
                                                                         << text;
    }
    if (!task.layout().sensing()) {
      const bool found = has_plan_by_width(task, limits, statistics, heuristics);
      EXPECT_EQ(found, exact[0] < kFar) << "seed " << seed << "\n" << text;
      by_width += found ? 1 : 0;
    }
    for (FactId x = 0; x < facts.size(); ++x)
      for (FactId y = x + 1; y < facts.size(); ++y)
        exclusive_pairs +=
            facts.fluent_of(x) != facts.fluent_of(y) && heuristics.invariants->exclusive(x, y) ? 1
                                                                                               : 0;
  }
  EXPECT_GT(tasks, 300);
  EXPECT_GT(states, 50'000U);
  EXPECT_GT(positive, 1000U);
  EXPECT_GT(dead, 1000U);
  EXPECT_GT(exclusive_pairs, 20U);
  EXPECT_GT(by_width, 100U);
  EXPECT_GT(applicable, 50'000U);
  std::printf("%d tasks, %lu states, %lu positive estimates, %lu dead ends, %lu exclusive pairs\n",
              tasks, static_cast<unsigned long>(states), static_cast<unsigned long>(positive),
              static_cast<unsigned long>(dead), static_cast<unsigned long>(exclusive_pairs));
}

}  // namespace
}  // namespace kaboum::plan::test
