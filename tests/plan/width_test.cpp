// Search by novelty: how states are held, what is new, and verdicts with and without pauses.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "goal_target.h"
#include "plan_test.h"
#include "search/difference_store.h"
#include "search/engine.h"
#include "search/novelty.h"

namespace kaboum::plan::test {
namespace {

/// So many atoms that each may become true or false; the first are to be true.
Model switches(int count, int goals = 1) {
  std::string text = "types: t\nconstants: t ";
  for (int i = 0; i < count; ++i) text += (i ? ", c" : "c") + std::to_string(i);
  text += "\npredicates: on(t)\n";
  text += "action up(?x : t) preconds: true effects: add(Kf, on(?x))\n";
  text += "action down(?x : t) preconds: true effects: add(Kf, !on(?x))\n";
  text += "goal: K(on(c0))";
  for (int i = 1; i < goals; ++i) text += " & K(on(c" + std::to_string(i) + "))";
  return model_of(text);
}

/// Random walks: states are known again, whatever led there, and read as they were.
void walk(int atoms) {
  const Model model = switches(atoms);
  const SolveOptions options;
  Statistics statistics;
  Limits limits(options, statistics);
  const Task task(model, limits);
  const Index words = task.layout().words(), fluents = task.layout().fluents().size();
  std::mt19937 random(atoms);
  const std::vector<Word> start = task.initial();
  DifferenceStore store(start.data(), words);
  std::map<std::vector<Word>, Index> numbers = {{start, 0}};
  std::vector<std::vector<Word>> states = {start};
  Knowledge scratch(task.layout());
  scratch.keep_log(true);
  std::size_t again = 0;
  for (int i = 0; i < 30'000; ++i) {
    const auto parent = static_cast<Index>(random() % states.size());
    const Word* const read = store.read(parent);
    ASSERT_TRUE(std::equal(read, read + words, states[parent].begin()));
    scratch.assign(read, store.hash(parent));
    for (unsigned k = random() % 4; k > 0; --k)
      scratch.learn_atom(static_cast<Index>(random() % 5 == 0 ? random() % fluents : random() % 4),
                         true);
    if (random() % 3 == 0)
      scratch.apply({Change::Kind::AddFalse, static_cast<Index>(random() % 4), 0, {}});
    const std::vector<Word> now(scratch.words(), scratch.words() + words);
    ASSERT_EQ(scratch.hash(), Knowledge::hash_of(now.data(), words));
    const auto [number, fresh] = store.insert(scratch, parent, i);
    const auto [known, added] = numbers.emplace(now, number);
    ASSERT_EQ(fresh, added);
    ASSERT_EQ(number, known->second);
    again += added ? 0 : 1;
    if (!added) continue;
    states.push_back(now);
    ASSERT_EQ(store.size(), states.size());
    ASSERT_EQ(store.path(number).back(), static_cast<Index>(i));
    ASSERT_EQ(store.path(number).size(), store.path(parent).size() + 1);
  }
  EXPECT_GT(again, 1000U);
  EXPECT_GT(states.size(), 1000U);
}

TEST(DifferenceStore, HoldsShortStates) { walk(100); }

TEST(DifferenceStore, HoldsLongStatesAsDifferences) {
  walk(5000);
  const Model model = switches(5000);
  const SolveOptions options;
  Statistics statistics;
  Limits limits(options, statistics);
  const Task task(model, limits);
  DifferenceStore store(task.initial().data(), task.layout().words());
  const std::size_t empty = store.bytes();
  Knowledge scratch(task.layout());
  scratch.keep_log(true);
  for (Index i = 0; i < 5000; ++i) {
    scratch.assign(store.read(0), store.hash(0));
    scratch.learn_atom(i, true);
    store.insert(scratch, 0, i);
  }
  EXPECT_EQ(store.size(), 5001U);
  EXPECT_LT(store.bytes() - empty, 5000U * 100) << "a state whole takes 1250 bytes";
}

TEST(Novelty, IsThatOfTheDefinition) {
  std::mt19937 random(7);
  for (const Index facts : {5U, 64U, 200U, 3000U}) {
    Novelty novelty(facts, 1 << 28);
    std::set<std::pair<Index, Index>> had;  // class, fact
    std::set<std::array<Index, 3>> pairs;   // class, fresh, present
    std::array<int, 4> counts{};
    for (int i = 0; i < 3000; ++i) {
      const Index state_class = random() % 3;
      std::set<Index> present;
      for (unsigned k = 1 + random() % 6; k > 0; --k) present.insert(random() % facts);
      std::vector<Index> all(present.begin(), present.end()), fresh;
      for (const Index f : all)
        if (random() % 2 != 0) fresh.push_back(f);
      int expected = 3;
      for (const Index f : fresh)
        for (const Index p : all)
          if (pairs.insert({state_class, f, p}).second) expected = 2;
      for (const Index f : fresh)
        if (had.emplace(state_class, f).second) expected = 1;
      ASSERT_EQ(novelty.of(state_class, fresh, all), expected);
      ++counts[static_cast<std::size_t>(expected)];
    }
    EXPECT_GT(counts[1], 0);
    EXPECT_GT(counts[2], 0);
    EXPECT_TRUE(counts[3] > 0 || facts > 64);
    EXPECT_TRUE(novelty.bytes() > 1U << 17U || facts < 3000) << "its table has grown";
  }
}

TEST(Novelty, PairsAreForgottenWhereTheyWouldTakeTooMuch) {
  Novelty novelty(1000, 1 << 12);
  for (Index f = 0; f + 1 < 1000; ++f) novelty.of(0, {f, f + 1}, {f, f + 1});
  EXPECT_LE(novelty.bytes(), (1U << 17U) + 1000 / 8);
  EXPECT_EQ(novelty.of(0, {3}, {3, 700}), 3) << "a pair, but no longer kept";
  EXPECT_EQ(novelty.of(1, {3}, {3, 700}), 1);
}

using Search = SearchResult (*)(const SearchInput&, std::uint64_t);

/// What a search finds with pauses after this much work.
SearchResult run(const Model& model, std::uint64_t work, Search search, Statistics& statistics,
                 const SolveOptions& options = {}) {
  Limits limits(options, statistics);
  Task task(model, limits);
  Heuristics heuristics;
  GoalTarget target(task);
  return search({task, task.initial(), target, limits, statistics, heuristics}, work);
}
SearchResult run(const Model& model, std::uint64_t work, Search search) {
  Statistics statistics;
  return run(model, work, search, statistics);
}

SearchResult by_width(const SearchInput& in, std::uint64_t work) {
  const auto engine = width_engine(in);
  for (;;)
    if (auto found = engine->advance(work, 0)) return *found;
}

TEST(Width, PausesChangeNothing) {
  for (const auto& [domain, n] : {std::pair("stacked", "6"), std::pair("remove", "9")}) {
    const Model model = scenario(domain, n);
    const SearchResult whole = run(model, std::uint64_t{1} << 60U, by_width);
    ASSERT_EQ(whole.outcome, Outcome::Solved);
    EXPECT_EQ(run(model, 1, by_width).steps, whole.steps);
    EXPECT_EQ(run(model, 1'000'000, by_width).steps, whole.steps);
  }
}

TEST(Width, TurnsFindWhatEitherFinds) {
  for (const auto& [domain, n] : {std::pair("stacked", "7"), std::pair("remove", "9")}) {
    const Model model = scenario(domain, n);
    for (const std::uint64_t first : {1U, 100'000U, 100'000'000U})
      EXPECT_EQ(run(model, first, take_turns).outcome, Outcome::Solved);
  }
  const Model none = model_of(
      "types: t\nconstants: t a, b, c, d\npredicates: on(t), done\ninit: K(!done)\n"
      "action up(?x : t) preconds: true effects: add(Kf, on(?x))\n"
      "action down(?x : t) preconds: true effects: add(Kf, !on(?x))\n"
      "action end preconds: K(on(a)) & K(!on(a)) effects: add(Kf, done)\ngoal: K(done)");
  for (const std::uint64_t first : {1U, 100'000U})
    EXPECT_EQ(run(none, first, take_turns).outcome, Outcome::Unsolvable);
}

/// Steps that disjunctive knowledge and excluded values make for themselves.
TEST(Width, TakesWhatIsKnownWithoutAStep) {
  const std::string switches =
      "types: t, v\nconstants: t c0, c1, c2, c3, c4, c5; v a, b, c\n"
      "predicates: on(t), done, x, y, p, q\nfunctions: f : v\n"
      "action up(?x : t) preconds: true effects: add(Kf, on(?x))\n"
      "action down(?x : t) preconds: true effects: add(Kf, !on(?x))\n";
  const std::string excluded =
      switches +
      "init: K(!done) K(f != a)\naction look preconds: K(f = b) effects: add(Kf, f != b)\n"
      "action leave preconds: K(on(c5)) effects: add(Kf, f != b)\n";
  const std::string group =
      switches +
      "init: K(!done) K(x) K(!q)\naction turn preconds: K(x) effects: add(Kf, y), add(Kf, !x)\n"
      "action guess preconds: K(y) & K(on(c5)) effects: add(Kx, p | q)\n";
  struct Case {
    std::string text;
    Outcome outcome;
  };
  const std::string end = "action end preconds: ", done = " effects: add(Kf, done)\ngoal: K(done)";
  for (const auto& [text, outcome] :
       {Case{excluded + end + "K(on(c0)) & K(!on(c0))" + done, Outcome::Unsolvable},
        Case{excluded + end + "K(f = c)" + done, Outcome::Solved},
        Case{group + end + "K(p) & K(x)" + done, Outcome::Unsolvable},
        Case{group + end + "K(p)" + done, Outcome::Solved}})
    for (const std::uint64_t first : {1U, 10'000U}) {
      const Model model = model_of(text);
      EXPECT_EQ(run(model, first, by_width).outcome, outcome) << text;
      EXPECT_EQ(run(model, first, take_turns).outcome, outcome) << text;
      EXPECT_EQ(solve(model, {Algorithm::BreadthFirst, 0, 0, {}}).outcome == Outcome::Solved,
                outcome == Outcome::Solved)
          << text;
    }
}

/// A scenario, beside many atoms that nothing brings about and nothing needs.
std::string padded(const std::string& domain, int atoms) {
  std::string text = slurp(KABOUM_DOMAINS "/" + domain + "/domain.kpl");
  std::string names;
  for (int i = 0; i < atoms; ++i) names += (i ? ", z" : "z") + std::to_string(i);
  text += "\ntypes: filler\nconstants: filler " + names +
          "\npredicates: filled(filler), never\n"
          "action fill(?f : filler) preconds: K(never) effects: add(Kf, filled(?f))\n";
  return text;
}

TEST(Width, LongStatesAreSearchedAsShortOnes) {
  for (const auto& [domain, n] : {std::pair("stacked", "6"), std::pair("remove", "9")}) {
    const Text problem{"problem.kpl", made(domain, n), Language::Kpl};
    const Model shorter = load({"domain.kpl", padded(domain, 10), Language::Kpl}, &problem);
    const Model longer = load({"domain.kpl", padded(domain, 3000), Language::Kpl}, &problem);
    for (const Search search : {by_width, take_turns}) {
      Statistics of_shorter, of_longer;
      const SearchResult a = run(shorter, 100'000'000, search, of_shorter);
      const SearchResult b = run(longer, 100'000'000, search, of_longer);
      ASSERT_EQ(a.outcome, Outcome::Solved);
      ASSERT_EQ(b.outcome, Outcome::Solved);
      EXPECT_EQ(a.steps.size(), b.steps.size());
      if (search != by_width) continue;
      EXPECT_EQ(of_shorter.expanded, of_longer.expanded);
      EXPECT_EQ(of_shorter.generated, of_longer.generated);
    }
  }
}

TEST(Width, TheLimitOfMemoryIsKept) {
  const Model model = switches(1000, 100);
  SolveOptions options;
  options.max_memory = 32 << 20;
  Statistics statistics;
  const Search quietly = [](const SearchInput& in, std::uint64_t work) {
    const SearchResult found = by_width(in, work);
    EXPECT_EQ(in.limits.reason(), "") << "another search may go on";
    return found;
  };
  EXPECT_EQ(run(model, 1'000'000, quietly, statistics, options).outcome, Outcome::Limit);
  EXPECT_GT(statistics.state_bytes, options.max_memory / 4);
  EXPECT_LE(statistics.state_bytes, options.max_memory);
  // Which is what take_turns does.
  EXPECT_EQ(run(model, 1, take_turns, statistics, options).outcome, Outcome::Solved);
}

/// A grid where things are collected one at a time and brought to a corner, with switches that do
/// not matter.
Model collecting(int width, int things, int switches) {
  std::string text = "types: cell, thing, switch\nconstants: cell ";
  for (int i = 0; i < width * width; ++i) text += (i ? ", c" : "c") + std::to_string(i);
  text += "; thing ";
  for (int i = 0; i < things; ++i) text += (i ? ", t" : "t") + std::to_string(i);
  text += "; switch ";
  for (int i = 0; i < switches; ++i) text += (i ? ", s" : "s") + std::to_string(i);
  text +=
      "\npredicates: at(cell), lies(thing, cell), held(thing), free, beside(cell, cell), "
      "on(switch)\nclosed: all\ninit: K(at(c0)) K(free)\n";
  const auto cell = [](int c) { return "c" + std::to_string(c); };
  for (int c = 0; c < width * width; ++c) {
    if (c % width < width - 1)
      text += "K(beside(" + cell(c) + ", " + cell(c + 1) + ")) K(beside(" + cell(c + 1) + ", " +
              cell(c) + ")) ";
    if (c + width < width * width)
      text += "K(beside(" + cell(c) + ", " + cell(c + width) + ")) K(beside(" + cell(c + width) +
              ", " + cell(c) + ")) ";
  }
  std::string goal = "\ngoal: true";
  for (int t = 0; t < things; ++t) {
    const std::string thing = "t" + std::to_string(t);
    text += "K(lies(" + thing + ", " + cell(width * width - 1 - t * (width - 1) / 2) + ")) ";
    goal += " & K(lies(" + thing + ", c0))";
  }
  text +=
      "\naction go(?a : cell, ?b : cell) preconds: K(at(?a)) & K(beside(?a, ?b))\n"
      "  effects: add(Kf, at(?b)), add(Kf, !at(?a))\n"
      "action take(?t : thing, ?c : cell) preconds: K(at(?c)) & K(lies(?t, ?c)) & K(free)\n"
      "  effects: add(Kf, held(?t)), add(Kf, !lies(?t, ?c)), add(Kf, !free)\n"
      "action put(?t : thing, ?c : cell) preconds: K(at(?c)) & K(held(?t))\n"
      "  effects: add(Kf, !held(?t)), add(Kf, lies(?t, ?c)), add(Kf, free)\n"
      "action flip(?s : switch) preconds: K(!on(?s)) effects: add(Kf, on(?s))\n"
      "action flop(?s : switch) preconds: K(on(?s)) effects: add(Kf, !on(?s))";
  return model_of(text + goal);
}

TEST(Width, NoveltyFindsTheWay) {
  for (int things = 1; things < 5; ++things) {
    Statistics statistics;
    SolveOptions options;
    options.timeout = 30;
    EXPECT_EQ(run(collecting(7, things, 12), 1, by_width, statistics, options).outcome,
              Outcome::Solved);
    EXPECT_LT(statistics.expanded, 1000U * static_cast<unsigned>(things)) << "of some 10^6 states";
  }
}

}  // namespace
}  // namespace kaboum::plan::test
