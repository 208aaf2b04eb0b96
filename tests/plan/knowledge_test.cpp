// Knowledge states against a naive implementation with sets of possible worlds.
#include <random>
#include <set>

#include "plan_test.h"
#include "task/knowledge.h"
#include "task/task.h"

namespace kaboum::plan::test {
namespace {

constexpr int kAtoms = 4;
constexpr int kValues = 3;

struct World {
  std::array<bool, kAtoms> atoms{};
  int value = 0;
  auto operator<=>(const World&) const = default;
};
using Class = std::set<World>;  ///< worlds that the agent cannot tell apart at run time

/// What the databases mean: before the plan runs, each of the classes may turn out.
class Naive {
 public:
  Naive() {
    Class all;
    for (int bits = 0; bits < (1 << kAtoms); ++bits)
      for (int v = 0; v < kValues; ++v) {
        World w;
        for (int i = 0; i < kAtoms; ++i)
          w.atoms[static_cast<std::size_t>(i)] = ((bits >> i) & 1) != 0;
        w.value = v;
        all.insert(w);
      }
    classes = {all};
  }

  template <class Change>
  void map(Change change) {  // each world to one or more worlds
    std::set<Class> next;
    for (const Class& c : classes) {
      Class made;
      for (const World& w : c) change(w, made);
      next.insert(std::move(made));
    }
    classes = std::move(next);
  }
  template <class Key>
  void split(Key key) {
    std::set<Class> next;
    for (const Class& c : classes) {
      std::map<int, Class> parts;
      for (const World& w : c) parts[key(w)].insert(w);
      for (auto& [k, part] : parts) next.insert(std::move(part));
    }
    classes = std::move(next);
  }
  template <class Test>
  bool always(Test test) const {
    for (const Class& c : classes)
      for (const World& w : c)
        if (!test(w)) return false;
    return true;
  }
  template <class Key>
  bool constant_in_classes(Key key) const {
    for (const Class& c : classes)
      for (const World& w : c)
        if (key(w) != key(*c.begin())) return false;
    return true;
  }

  std::set<Class> classes;
};

const char* const kModel =
    "types: value\nconstants: value v0, v1, v2\npredicates: p0, p1, p2, p3\nfunctions: f : value\n"
    "action all preconds: true effects: add(Kf, p0), add(Kf, p1), add(Kf, p2), add(Kf, p3), "
    "add(Kf, f != v0)\n"
    "action groups preconds: true effects: add(Kx, p0 | p1 | p2), add(Kx, p1 | p3)\n"
    "action sense preconds: true effects: add(Kw, p0), add(Kv, f)\n"
    "goal: K(p0)\n";

/// Compares every claim of the packed state with the worlds.
void compare(const Knowledge& k, const Layout& layout, const Naive& naive, bool exactly) {
  for (Index i = 0; i < layout.fluents().size(); ++i) {
    const Fluent& f = layout.fluents()[i];
    if (f.function) {
      const Word content = k.value(i);
      const auto value = [](const World& w) { return w.value; };
      bool known = false;
      for (int v = 0; v < kValues; ++v) {
        const bool is = naive.always([&](const World& w) { return w.value == v; });
        known |= is;
        if (content == kFirstValue + static_cast<Word>(v)) {
          EXPECT_TRUE(is);
        } else if (exactly) {
          EXPECT_FALSE(is);
        }
        const bool never = naive.always([&](const World& w) { return w.value != v; });
        const bool claimed =
            k.excluded(i, static_cast<Index>(v)) ||
            (content >= kFirstValue && content != kFirstValue + static_cast<Word>(v));
        if (claimed) {
          EXPECT_TRUE(never);
        }
        if (exactly) {
          EXPECT_EQ(claimed, never);
        }
      }
      if (content == kValueSensed) {
        EXPECT_TRUE(naive.constant_in_classes(value));
      }
      if (exactly && !known) {
        EXPECT_EQ(content == kValueSensed, naive.constant_in_classes(value));
      }
    } else {
      const std::size_t a = f.symbol;
      const bool yes = naive.always([&](const World& w) { return w.atoms[a]; });
      const bool no = naive.always([&](const World& w) { return !w.atoms[a]; });
      const bool whether = naive.constant_in_classes([&](const World& w) { return w.atoms[a]; });
      const AtomKnowledge s = k.atom(i);
      if (s == AtomKnowledge::True) {
        EXPECT_TRUE(yes);
      }
      if (s == AtomKnowledge::False) {
        EXPECT_TRUE(no);
      }
      if (s == AtomKnowledge::Whether) {
        EXPECT_TRUE(whether);
      }
      if (!exactly) continue;
      const AtomKnowledge expected = yes       ? AtomKnowledge::True
                                     : no      ? AtomKnowledge::False
                                     : whether ? AtomKnowledge::Whether
                                               : AtomKnowledge::Unknown;
      EXPECT_EQ(s, expected);
    }
  }
}

/// Random updates; `groups` allows Kx, with which inference is sound but not complete.
void random_walk(std::uint32_t seed, bool groups) {
  const Model model = model_of(kModel);
  const SolveOptions options;
  Statistics statistics;
  Limits limits(options, statistics);
  const Layout layout(model, limits);
  std::vector<Index> atom(kAtoms);
  Index term = kNone;
  for (Index i = 0; i < layout.fluents().size(); ++i) {
    if (layout.fluents()[i].function) {
      term = i;
    } else {
      atom[layout.fluents()[i].symbol] = i;
    }
  }
  std::mt19937 random(seed);
  Knowledge k(layout);
  k.keep_log(true);
  Naive naive;
  using C = Change::Kind;
  for (int step = 0; step < 25; ++step) {
    const std::size_t a = random() % kAtoms;
    const int v = static_cast<int>(random() % kValues);
    const Index fluent = atom[a];
    const auto value = static_cast<Index>(v);
    const bool sensed_atom = k.atom(fluent) == AtomKnowledge::Whether;
    const bool sensed_term = k.value(term) == kValueSensed;
    bool any_sensed = false;
    for (const Index f : atom) any_sensed |= k.atom(f) == AtomKnowledge::Whether;
    const std::vector<Word> before(k.words(), k.words() + layout.words());
    const std::size_t mark = k.mark();
    const auto set_atom = [&](bool truth) {
      naive.map([&](World w, Class& out) {
        w.atoms[a] = truth;
        out.insert(w);
      });
    };
    const auto free_atom = [&](bool only) {
      naive.map([&](World w, Class& out) {
        out.insert(w);
        if (w.atoms[a] != only) return;
        w.atoms[a] = !only;
        out.insert(w);
      });
    };
    const auto free_value = [&](const auto& which) {
      naive.map([&](World w, Class& out) {
        out.insert(w);
        if (!which(w)) return;
        for (w.value = 0; w.value < kValues; ++w.value) out.insert(w);
      });
    };
    // The planner decides sensed values before an update whose result depends on them.
    const bool tied = groups && any_sensed;
    switch (random() % 14) {
      case 0:
        if (tied) break;
        k.apply({C::AddTrue, fluent, 0, {}});
        set_atom(true);
        break;
      case 1:
        if (tied) break;
        k.apply({C::AddFalse, fluent, 0, {}});
        set_atom(false);
        break;
      case 2:
      case 3: {
        const bool positive = random() % 2 == 0;
        if (sensed_atom || tied) break;
        k.apply({positive ? C::DeleteTrue : C::DeleteFalse, fluent, 0, {}});
        free_atom(positive);
        break;
      }
      case 4:
        k.apply({C::AddWhether, fluent, 0, {}});
        naive.split([&](const World& w) { return w.atoms[a] ? 1 : 0; });
        break;
      case 5:
        if (tied) break;
        k.apply({C::Forget, fluent, 0, {}});
        free_atom(true);
        free_atom(false);
        break;
      case 6:
        k.apply({C::AddValue, term, value, {}});
        naive.map([&](World w, Class& out) {
          w.value = v;
          out.insert(w);
        });
        break;
      case 7:
        if (sensed_term) break;
        k.apply({C::DeleteValue, term, value, {}});
        free_value([&](const World& w) { return w.value == v; });
        break;
      case 8:
        if (sensed_term) break;
        k.apply({C::Exclude, term, value, {}});
        if (naive.always([&](const World& w) { return w.value == v; }))
          free_value([](const World&) { return true; });
        naive.map([&](const World& w, Class& out) {
          if (w.value != v) out.insert(w);
        });
        break;
      case 9:
        if (sensed_term) break;
        k.apply({C::DeleteExclude, term, value, {}});
        free_value([&](const World& w) { return w.value != v; });
        break;
      case 10:
        k.apply({C::AddSensed, term, 0, {}});
        naive.split([](const World& w) { return w.value; });
        break;
      case 11: {  // an outcome
        if (!sensed_atom) break;
        const bool truth = random() % 2 == 0;
        std::erase_if(naive.classes, [&](const Class& c) { return c.begin()->atoms[a] != truth; });
        const bool possible = k.learn_atom(fluent, truth);
        if (naive.classes.empty()) return;
        EXPECT_TRUE(possible);
        break;
      }
      case 12: {
        if (!groups) break;
        const Index g = random() % layout.groups().size();
        const auto consistent = [&](const World& w) {
          int n = 0;
          for (const Index m : layout.groups()[g].members)
            n += w.atoms[layout.fluents()[m].symbol] ? 1 : 0;
          return n == 1;
        };
        bool possible = !any_sensed;
        for (const Class& c : naive.classes)
          possible &= std::any_of(c.begin(), c.end(), consistent);
        if (!possible) break;
        naive.map([&](const World& w, Class& out) {
          if (consistent(w)) out.insert(w);
        });
        k.apply({C::AddGroup, g, 0, {}});
        break;
      }
      default: {  // an outcome of a term
        if (!sensed_term) break;
        std::erase_if(naive.classes, [&](const Class& c) { return c.begin()->value != v; });
        const bool possible = k.learn_value(term, value);
        if (naive.classes.empty()) return;
        EXPECT_TRUE(possible);
        break;
      }
    }
    compare(k, layout, naive, !groups);
    EXPECT_EQ(k.hash(), Knowledge::hash_of(k.words(), layout.words()));
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << "seed " << seed << ", step " << step;
      return;
    }
    // Undo, then redo by assignment.
    const std::vector<Word> after(k.words(), k.words() + layout.words());
    k.undo(mark);
    EXPECT_TRUE(std::equal(before.begin(), before.end(), k.words()));
    k.assign(after.data());
  }
}

TEST(Knowledge, IsExactWithoutExclusiveOr) {
  for (std::uint32_t seed = 0; seed < 1500 && !HasFailure(); ++seed) random_walk(seed, false);
}

TEST(Knowledge, IsSoundWithExclusiveOr) {
  for (std::uint32_t seed = 0; seed < 1500 && !HasFailure(); ++seed) random_walk(seed, true);
}

TEST(Knowledge, AddingAnAtomClearsItsNegationAndWhether) {
  const Model model = model_of(kModel);
  const SolveOptions options;
  Statistics statistics;
  Limits limits(options, statistics);
  const Layout layout(model, limits);
  Knowledge k(layout);
  Index p = kNone;
  for (Index i = 0; i < layout.fluents().size(); ++i)
    if (!layout.fluents()[i].function) p = i;
  k.apply({Change::Kind::AddFalse, p, 0, {}});
  k.apply({Change::Kind::AddTrue, p, 0, {}});
  EXPECT_EQ(k.atom(p), AtomKnowledge::True);
  k.apply({Change::Kind::Forget, p, 0, {}});
  k.apply({Change::Kind::AddWhether, p, 0, {}});
  EXPECT_EQ(k.atom(p), AtomKnowledge::Whether);
  k.apply({Change::Kind::AddFalse, p, 0, {}});
  EXPECT_EQ(k.atom(p), AtomKnowledge::False);
}

}  // namespace
}  // namespace kaboum::plan::test
