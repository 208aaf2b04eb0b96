// Search: proofs of unsolvability, limits, dead ends, n-way branches, optimality on random tasks.
#include <random>

#include "goal_target.h"
#include "plan_test.h"
#include "search/engine.h"

namespace kaboum::plan::test {
namespace {

TEST(Search, UnsolvableIsToldFromLimit) {
  // The goal needs q, which nothing brings about.
  const Model m = model_of(
      "predicates: p, q\ninit: K(!p) K(!q)\naction on preconds: K(!p) effects: add(Kf, p)\n"
      "action off preconds: K(p) effects: add(Kf, !p)\naction never preconds: false effects: "
      "add(Kf, q)\ngoal: K(q)");
  for (const Algorithm a : kAll) EXPECT_EQ(solve(m, {a, 0, 0, {}}).outcome, Outcome::Unsolvable);

  const Model large = scenario("stacked", "9");
  SolveOptions options;
  options.max_memory = 1 << 20;
  const Solution s = solve(large, options);
  EXPECT_EQ(s.outcome, Outcome::Limit);
  EXPECT_NE(s.limit.find("memory"), std::string::npos);
}

TEST(Search, PreconditionsMayHaveThousandsOfConjuncts) {
  // The last one, which no rule joins, is brought about; or it is not.
  constexpr int kCount = 2000;
  const auto task = [](const std::string& last) {
    std::string atoms, init, all;
    for (int i = 0; i < kCount; ++i) {
      const std::string p = "p" + std::to_string(i);
      atoms += p + ", ";
      init += i + 1 < kCount ? "K(" + p + ") " : "K(!" + p + ") ";
      all += "K(" + p + ") & ";
    }
    return model_of("types: t\nconstants: t a, b\npredicates: " + atoms +
                    "on(t), done\ninit: K(!done) K(on(a)) K(!on(b)) " + init +
                    "\naction go(?x : t) preconds: " + all +
                    "K(on(?x)) & K(?x != a) effects: add(Kf, done)\n"
                    "action put preconds: !K(done) effects: add(Kf, on(b))\n"
                    "action last preconds: !K(done) effects: add(Kf, " +
                    last + ")\ngoal: K(done)");
  };
  for (const Algorithm a : {Algorithm::Greedy, Algorithm::AStar}) {
    const Solution s = solved(task("p" + std::to_string(kCount - 1)), a);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    EXPECT_EQ(s.plan.nodes.size(), 3U);
    EXPECT_EQ(solve(task("on(a)"), {a, 0, 0, {}}).outcome, Outcome::Unsolvable);
  }
}

/// Says the same of each state.
struct Constant : Evaluator {
  Constant(std::uint64_t value, bool dead_end, bool safe)
      : estimate{value, dead_end, 1}, safe(safe) {}
  Estimate evaluate(const Word*) override { return estimate; }
  [[nodiscard]] bool is_safe() const override { return safe; }
  Estimate estimate;
  bool safe;
};

/// A guess that is wrong and no proof, a guess that tells nothing, and a wrong "proof".
std::unique_ptr<Evaluator> pessimist(Task&, Limits&, Heuristics&) {
  return std::make_unique<Constant>(0, true, false);
}
std::unique_ptr<Evaluator> ignorant(Task&, Limits&, Heuristics&) {
  return std::make_unique<Constant>(7, false, true);
}
std::unique_ptr<Evaluator> liar(Task&, Limits&, Heuristics&) {
  return std::make_unique<Constant>(0, true, true);
}

/// How greedy search with these evaluators ends; its plan is tried.
Outcome greedy_with(const Model& model, std::vector<EvaluatorMaker*> evaluators) {
  const SolveOptions options;
  Statistics statistics;
  Limits limits(options, statistics);
  Task task(model, limits);
  Heuristics heuristics;
  GoalTarget target(task);
  const std::vector<Word>& start = task.initial();
  const SearchInput in{task, start, target, limits, statistics, heuristics};
  const SearchResult result =
      greedy_engine(in, evaluators, 1'000'000)->advance(std::uint64_t{1} << 60U, 0).value();
  if (result.outcome != Outcome::Solved) return result.outcome;
  Knowledge state(task.layout());
  state.assign(start.data());
  for (const OperatorId step : result.steps) {
    EXPECT_TRUE(task.evaluator().holds(task.action(step).precondition, state.words()));
    EXPECT_TRUE(task.apply(step, state));
  }
  EXPECT_TRUE(target.reached(state.words()));
  return result.outcome;
}

TEST(Search, GreedyTakesAnyListOfEvaluators) {
  const Model model = scenario("stacked", "4");
  using List = std::vector<EvaluatorMaker*>;
  for (const List& list :
       {List{relaxed_plan_steps}, List{landmark_steps}, List{landmark_cost},
        List{landmark_steps, relaxed_plan_steps, landmark_cost}, List{relaxed_plan_steps, ignorant},
        List{ignorant}, List{pessimist}, List{pessimist, relaxed_plan_steps, pessimist}})
    EXPECT_EQ(greedy_with(model, list), Outcome::Solved) << list.size();
  // Only what is called a proof ends a search.
  EXPECT_EQ(greedy_with(model, {liar}), Outcome::Unsolvable);
  EXPECT_EQ(greedy_with(model, {relaxed_plan_steps, liar}), Outcome::Unsolvable);
}

TEST(Search, SensingThatDoesNotHelpIsNoPlan) {
  // Weighing tells, but the full box cannot be moved: only one outcome has a plan.
  const Model m = model_of(
      "predicates: full, moved\ninit: K(!moved)\naction weigh preconds: !Kw(full) effects: add(Kw, "
      "full)\n"
      "action move preconds: K(!full) & K(!moved) effects: add(Kf, moved)\ngoal: K(moved)");
  for (const Algorithm a : kAll) EXPECT_EQ(solve(m, {a, 0, 0, {}}).outcome, Outcome::Unsolvable);
}

TEST(Search, ADeadEndOfOneBranchIsAvoided) {
  // `peek` is cheap, but when it shows red the door locks; `ask` costs a step more and is safe.
  const Model m = model_of(
      "predicates: red, locked, ready, open\ninit: K(!locked) K(!ready) K(!open)\n"
      "action peek preconds: !Kw(red) effects: add(Kw, red), add(Kf, locked)\n"
      "action prepare preconds: K(!ready) effects: add(Kf, ready)\n"
      "action ask preconds: K(ready) & !Kw(red) effects: add(Kw, red)\n"
      "action push preconds: K(red) & K(!locked) effects: add(Kf, open)\n"
      "action pull preconds: K(!red) effects: add(Kf, open)\ngoal: K(open)");
  for (const Algorithm a : kAll) {
    const Solution s = solved(m, a);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    EXPECT_GE(s.statistics.dead_ends, 1U);
  }
}

TEST(Search, RepeatingUntilLuckyIsNoPlan) {
  // Tossing again and again would be a cycle: a plan must end on every branch.
  const Model m = model_of(
      "predicates: heads, won\ninit: K(!won)\n"
      "action toss preconds: true effects: del(Kw, heads), add(Kw, heads)\n"
      "action win preconds: K(heads) effects: add(Kf, won)\ngoal: K(won)");
  for (const Algorithm a : kAll) EXPECT_EQ(solve(m, {a, 0, 0, {}}).outcome, Outcome::Unsolvable);
}

TEST(Search, BranchesOnEveryValueOfASensedFunction) {
  const Model m = model_of(
      "types: room\nconstants: room kitchen, hall, cellar\nfunctions: at : room\npredicates: "
      "found, checked(room)\n"
      "init: K(!found)\naction ask preconds: !Kv(at) effects: add(Kv, at)\n"
      "action go(?r : room) preconds: K(at = ?r) effects: add(Kf, found)\ngoal: K(found)");
  for (const Algorithm a : kAll) {
    const Solution s = solved(m, a);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    const PlanSize size = measure(m, s.plan);
    EXPECT_EQ(size.leaves, 3U);
    EXPECT_EQ(size.longest, 2U);
  }
}

TEST(Search, RuledOutValuesNeedNoCase) {
  const Model m = model_of(
      "types: room\nconstants: room kitchen, hall, cellar\nfunctions: at : room\npredicates: "
      "found\n"
      "init: K(!found) Kx(at = kitchen | at = hall)\naction ask preconds: !Kv(at) effects: add(Kv, "
      "at)\n"
      "action go(?r : room) preconds: K(at = ?r) & K(?r != cellar) effects: add(Kf, found)\ngoal: "
      "K(found)");
  const Solution s = solved(m, Algorithm::BreadthFirst);
  ASSERT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(measure(m, s.plan).leaves, 2U);
}

TEST(Search, ExclusiveOrSpreadsWhatIsSensed) {
  // One of three boxes holds the key; looking into two of them is enough.
  const Model m = model_of(
      "types: box\nconstants: box a, b, c\npredicates: key(box), seen(box), taken\n"
      "init: Kx(key(a) | key(b) | key(c)) K(!taken)\n"
      "action look(?x : box) preconds: !Kw(key(?x)) & K(?x != c) effects: add(Kw, key(?x))\n"
      "action take(?x : box) preconds: K(key(?x)) effects: add(Kf, taken)\ngoal: K(taken)");
  for (const Algorithm a : kAll) {
    const Solution s = solved(m, a);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    EXPECT_EQ(measure(m, s.plan).leaves, 3U);
  }
}

TEST(Search, IsDeterministic) {
  const Model m = scenario("bartender", "4");
  for (const Algorithm a : {Algorithm::Greedy, Algorithm::BreadthFirst}) {
    const std::string first = write_plan(m, solve(m, {a, 0, 0, {}}).plan);
    EXPECT_EQ(first, write_plan(m, solve(m, {a, 0, 0, {}}).plan));
  }
}

/// A random classical task: small, some solvable, some not.
std::string random_task(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::string text =
      "types: v\nconstants: v a, b, c\npredicates: p0, p1, p2, p3, p4\nfunctions: f : v; g : "
      "v\ninit: ";
  for (int i = 0; i < 5; ++i)
    text += std::string("K(") + (random() % 2 ? "!" : "") + "p" + std::to_string(i) + ") ";
  text += "K(f = a) K(g = b)\n";
  const auto literal = [&](bool goal) {
    if (random() % 3 == 0)
      return std::string(random() % 2 ? "f" : "g") + " = " +
             std::string(1, static_cast<char>('a' + random() % 3));
    return std::string(!goal && random() % 2 ? "!" : "") + "p" + std::to_string(random() % 5);
  };
  const int actions = 4 + static_cast<int>(random() % 5);
  for (int i = 0; i < actions; ++i) {
    text += "action act" + std::to_string(i) + " preconds: K(" + literal(false) + ") & K(" +
            literal(false) + ") effects: ";
    text += "add(Kf, " + literal(false) + "), ";
    if (random() % 2) text += "K(" + literal(false) + ") => add(Kf, " + literal(false) + "), ";
    text += "add(Kf, " + literal(false) + ")\n  cost: " + std::to_string(random() % 4) + "\n";
  }
  return text + "goal: K(" + literal(true) + ") & K(" + literal(true) + ") & K(" + literal(true) +
         ")\n";
}

/// Least cost by the plainest means: Dijkstra would do; here A* must agree with exhaustive search
/// over unit costs, and must not exceed any other search's cost.
TEST(Search, AStarIsOptimalOnRandomTasks) {
  int solvable = 0;
  for (std::uint32_t seed = 0; seed < 600; ++seed) {
    std::string text = random_task(seed);
    const Model weighted = model_of(text);
    for (std::size_t at = 0; (at = text.find("cost: ", at)) != std::string::npos; ++at)
      text[at + 6] = '1';
    const Model unit = model_of(text);
    const Solution reference = solved(unit, Algorithm::BreadthFirst);
    for (const Algorithm a : kAll) EXPECT_EQ(solved(unit, a).outcome, reference.outcome) << text;
    const Solution best = solved(unit, Algorithm::AStar);
    if (reference.outcome != Outcome::Solved) continue;
    ++solvable;
    EXPECT_EQ(measure(unit, best.plan).longest, measure(unit, reference.plan).longest) << text;
    EXPECT_EQ(measure(unit, solved(unit, Algorithm::IterativeDeepening).plan).longest,
              measure(unit, reference.plan).longest);
    const std::int64_t cost = measure(weighted, solved(weighted, Algorithm::AStar).plan).cost;
    for (const Algorithm a : kAll)
      EXPECT_LE(cost, measure(weighted, solved(weighted, a).plan).cost) << text;
    EXPECT_LE(best.statistics.initial_estimate.value_or(0),
              static_cast<std::int64_t>(measure(unit, reference.plan).longest));
    if (HasFailure()) return;
  }
  EXPECT_GT(solvable, 100);
}

/// A random task with incomplete knowledge, sensing, loss of knowledge and disjunctions.
std::string random_sensing_task(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::string text =
      "types: v\nconstants: v a, b, c\npredicates: p0, p1, p2, p3\nfunctions: f : v\ninit: ";
  for (int i = 0; i < 4; ++i)
    if (random() % 2)
      text += std::string("K(") + (random() % 2 ? "!" : "") + "p" + std::to_string(i) + ") ";
  // The other entries must not contradict these: they are about atoms of their own.
  text.insert(text.find("p0, p1"), "x0, x1, x2, ");
  if (random() % 2) text += "Kx(x0 | x1 | x2) ";
  if (random() % 3 == 0) text += "Kw(x0) ";
  if (random() % 3 == 0) text += "Kx(f = a | f = b) ";
  text += "\n";
  const auto atom = [&] {
    return random() % 3 == 0 ? "x" + std::to_string(random() % 3)
                             : "p" + std::to_string(random() % 4);
  };
  const auto literal = [&]() -> std::string {
    if (random() % 4 == 0) return std::string("f = ") + static_cast<char>('a' + random() % 3);
    return (random() % 2 ? "!" : "") + atom();
  };
  const auto query = [&]() -> std::string {
    switch (random() % 6) {
      case 0:
        return "!Kw(" + atom() + ")";
      case 1:
        return "!K(" + literal() + ")";
      case 2:
        return "(K(" + literal() + ") | K(" + literal() + "))";
      default:
        return "K(" + literal() + ")";
    }
  };
  const auto effect = [&]() -> std::string {
    switch (random() % 9) {
      case 0:
      case 1:
        return "add(Kw, " + atom() + ")";
      case 2:
        return "add(Kv, f)";
      case 3:
        return "del(Kf, " + literal() + ")";
      case 4:
        return query() + " => add(Kf, " + literal() + ")";
      case 5:
        return "del(Kw, " + atom() + ")";
      default:
        return "add(Kf, " + literal() + ")";
    }
  };
  const int actions = 4 + static_cast<int>(random() % 5);
  for (int i = 0; i < actions; ++i) {
    text += "action act" + std::to_string(i) + " preconds: " + query() +
            (random() % 2 ? " & " + query() : "");
    text += " effects: " + effect() + (random() % 2 ? ", " + effect() : "") + "\n";
  }
  const std::string sensed = atom();
  const std::string other = atom();
  // Knowing a value needs a branch once it is sensed.
  return text + "goal: (K(" + sensed + ") | K(!" + sensed + ")) & (K(" + other + ") | K(" +
         literal() + "))\n";
}

/// Five searches that try things in different orders agree on what can be solved, and the
/// validator, which knows nothing of packed states or open queries, accepts every plan.
TEST(Search, AllAgreeOnRandomTasksWithSensing) {
  int branching = 0;
  int unsolvable = 0;
  for (std::uint32_t seed = 0; seed < 6000 && !HasFailure(); ++seed) {
    const std::string text = random_sensing_task(seed);
    const Model m = model_of(text);
    const Solution reference = solved(m, Algorithm::BreadthFirst);
    for (const Algorithm a : {Algorithm::DepthFirst, Algorithm::IterativeDeepening,
                              Algorithm::Greedy, Algorithm::AStar})
      EXPECT_EQ(solved(m, a).outcome, reference.outcome) << "seed " << seed << "\n" << text;
    EXPECT_NE(reference.outcome, Outcome::Limit);
    unsolvable += reference.outcome == Outcome::Unsolvable ? 1 : 0;
    if (reference.outcome == Outcome::Solved && measure(m, reference.plan).branches > 0)
      ++branching;
  }
  EXPECT_GT(branching, 50);
  EXPECT_GT(unsolvable, 50);
}

}  // namespace
}  // namespace kaboum::plan::test
