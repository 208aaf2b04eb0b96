// Planning with sets of possible worlds: verdicts against an exhaustive search over beliefs, and
// small tasks in the spirit of the public ones.
#include <algorithm>
#include <random>

#include "contingent_model.h"
#include "plan_test.h"
#include "possible_worlds.h"
#include "random_model.h"
#include "works_merged.h"

namespace kaboum::plan::test {
namespace {

struct Count {
  int solvable = 0, unsolvable = 0, branching = 0, weak = 0;
};

/// `weak`: where conditions of knowledge stand in effects, a failure may claim less.
void compare(const std::string& text, Count& count, bool weak) {
  const Model m = model_of(text);
  std::optional<bool> expected;
  const Worlds worlds(m);
  for (const Belief& b : worlds.initial())
    if (b.empty()) {
      EXPECT_THROW(solve(m, {}), Error) << text;
      return;
    }
  std::size_t possible = 0;
  for (const Belief& b : worlds.initial()) possible += b.size();
  if (possible == 0 || possible > 160) return;  // too many for the oracle
  expected = has_plan(m, 120);
  if (!expected) return;
  ++(*expected ? count.solvable : count.unsolvable);
  for (const Algorithm a : {Algorithm::Greedy, Algorithm::BreadthFirst}) {
    const Solution s = solved(m, a);
    const bool claims_less = weak && !*expected && s.outcome == Outcome::NotInferred;
    count.weak += claims_less ? 1 : 0;
    EXPECT_TRUE(s.outcome == (*expected ? Outcome::Solved : Outcome::Unsolvable) || claims_less)
        << text << s.lost;
    if (s.outcome == Outcome::Solved && measure(m, s.plan).branches > 0) ++count.branching;
  }
}

TEST(Beliefs, VerdictsOnContingentTasksAreThoseOfAnExhaustiveSearch) {
  Count count;
  for (std::uint32_t seed = 0; seed < 1800 && !HasFailure(); ++seed)
    compare(ContingentGenerator(seed).model(), count, false);
  EXPECT_GT(count.solvable + count.unsolvable, 1000);
  EXPECT_GT(count.solvable, 200);
  EXPECT_GT(count.unsolvable, 200);
  EXPECT_GT(count.branching, 15);
}

TEST(Beliefs, VerdictsWithEveryKindOfUpdateAreThoseOfAnExhaustiveSearch) {
  Count count;
  for (std::uint32_t seed = 0; seed < 300 && !HasFailure(); ++seed)
    compare(Generator(seed + 300'000, false).model(4, 0), count, true);
  EXPECT_GT(count.solvable, 25);
  EXPECT_GT(count.unsolvable, 25);
}

TEST(Beliefs, WhatWorksFromWhatRunsHaveInCommonWorksInEachOfThem) {
  std::mt19937 random(1);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int works = 0;
  int fails = 0;
  for (std::uint32_t seed = 0; seed < 1500 && !HasFailure(); ++seed) {
    const std::string text = ContingentGenerator(seed + 700'000).model();
    const Model m = model_of(text);
    Solution s;
    try {
      s = solve(m, {});
    } catch (const Error&) {
      continue;  // the initial knowledge contradicts itself
    }
    if (s.outcome != Outcome::Solved || s.plan.root == kNone) continue;
    for (int i = 0; i < 8; ++i) {
      Plan p = s.plan;
      Plan::Node& n = p.nodes[pick(p.nodes.size())];
      const Index to = pick(3) == 0 ? kNone : static_cast<Index>(pick(p.nodes.size()));
      if (i > 0 && pick(2) == 0) std::swap(n.action, p.nodes[pick(p.nodes.size())].action);
      if (i > 0) (n.branches ? n.branch.cases[pick(n.branch.cases.size())].next : n.next) = to;
      try {
        measure(m, p);
      } catch (const Error&) {
        continue;  // a cycle
      }
      if (!works_merged(m, p)) {
        ++fails;
        continue;
      }
      ++works;
      EXPECT_TRUE(check(m, p).valid) << "seed " << seed << "\n" << text << plan_text(m, p);
    }
  }
  EXPECT_GT(works, 150);
  EXPECT_GT(fails, 70);
}

/// Find out where one is in a ring of n cells, one of them with a wall, by looking and moving: only
/// effects that are conditional in the world tell how the unknown position changes.
std::string lost_in_a_ring(int n) {
  std::string cells;
  std::string start;
  std::string moves;
  for (int i = 0; i < n; ++i) {
    const std::string c = "c" + std::to_string(i);
    const std::string next = "c" + std::to_string((i + 1) % n);
    cells += " " + c;
    start += " (at " + c + ")";
    moves += "(when (at " + c + ") (and (not (at " + c + ")) (at " + next + ")))";
  }
  return "(define (domain ring) (:types cell) (:constants" + cells +
         " - cell) (:predicates (at ?c - cell) (wall) (looked))"
         " (:action look :effect (and (when (at c0) (wall)) (when (not (at c0)) (not (wall)))"
         "  (looked)))"
         " (:action sense :precondition (looked) :observe (wall))"
         " (:action move :effect (and (not (looked)) " +
         moves + "))) (define (problem p) (:domain ring) (:init (oneof" + start +
         ")) (:goal (at c1)))";
}

Model pddl(const std::string& text) { return load({"t.pddl", text, Language::Pddl}, nullptr); }

TEST(Beliefs, EffectsThatHangOnAnUnknownPosition) {
  for (const int n : {2, 5, 9}) {
    const Model m = pddl(lost_in_a_ring(n));
    const Solution s = solved(m, Algorithm::Greedy);
    EXPECT_EQ(s.outcome, Outcome::Solved) << n;
    EXPECT_GE(measure(m, s.plan).branches, 1U);
  }
}

TEST(Beliefs, OneOfMoreThan64) {
  const int n = 130;
  std::string atoms;
  std::string constants;
  for (int i = 0; i < n; ++i) {
    constants += " i" + std::to_string(i);
    atoms += " (ill i" + std::to_string(i) + ")";
  }
  const std::string text =
      "(define (domain pks) (:types illness) (:constants" + constants +
      " - illness) (:predicates (ill ?i - illness) (stain ?i - illness) (cured))"
      " (:action stain :effect (forall (?i - illness) (when (ill ?i) (stain ?i))))"
      " (:action inspect :parameters (?i - illness) :observe (stain ?i))"
      " (:action medicate :parameters (?i - illness) :precondition (ill ?i) :effect (cured)))"
      "(define (problem p) (:domain pks) (:init (oneof" +
      atoms + ")) (:goal (cured)))";
  const Model m = pddl(text);
  const Solution s = solved(m, Algorithm::Greedy);
  EXPECT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(measure(m, s.plan).leaves, static_cast<std::uint64_t>(n));
}

TEST(Beliefs, ComponentsAreKeptApart) {
  // Twelve rooms with five doors each, one of them open: 5^12 worlds, 12 components.
  std::string text =
      "types: room, door constants: door a, b, c, d, e; room r0, r1, r2, r3, r4, r5, r6, r7, r8, "
      "r9, r10, r11, r12 predicates: open(room, door), next(room, room), in(room) closed: next, "
      "in init: K(in(r0)) ";
  for (int i = 0; i < 12; ++i) {
    const std::string r = "r" + std::to_string(i);
    text += "K(next(" + r + ", r" + std::to_string(i + 1) + ")) Kx(open(" + r + ", a) | open(" + r +
            ", b) | open(" + r + ", c) | open(" + r + ", d) | open(" + r + ", e)) ";
  }
  text +=
      "action feel(?r : room, ?d : door) preconds: K(in(?r)) effects: add(Kw, open(?r, ?d)) "
      "action go(?r : room, ?s : room, ?d : door) preconds: K(in(?r)) & K(next(?r, ?s)) & "
      "K(open(?r, ?d)) effects: add(Kf, !in(?r)), add(Kf, in(?s)) goal: K(in(r12))";
  const Model m = model_of(text);
  const Solution s = solved(m, Algorithm::Greedy);
  EXPECT_EQ(s.outcome, Outcome::Solved);
  const PlanSize size = measure(m, s.plan);
  EXPECT_EQ(size.leaves, 244140625U);
  EXPECT_LE(size.nodes, 12U * 9U);
}

TEST(Beliefs, WhatBranchesNeedNotTellApartTheyShare) {
  // Ten coins are each looked at and turned if need be; what was seen does not matter later.
  std::string text =
      "types: coin constants: coin k0, k1, k2, k3, k4, k5, k6, k7, k8, k9 predicates: "
      "heads(coin) init: Or(heads(k0) | heads(k1)) Or(!heads(k0) | !heads(k2)) ";
  for (int i = 2; i < 9; ++i)
    text += "Or(heads(k" + std::to_string(i) + ") | heads(k" + std::to_string(i + 1) + ")) ";
  text +=
      "action look(?c : coin) preconds: true effects: add(Kw, heads(?c)) action turn(?c : coin) "
      "preconds: K(!heads(?c)) effects: add(Kf, heads(?c)) goal: forallK(?c : coin) K(heads(?c))";
  const Model m = model_of(text);
  const Solution s = solved(m, Algorithm::Greedy);
  EXPECT_EQ(s.outcome, Outcome::Solved);
  EXPECT_LE(measure(m, s.plan).nodes, 200U);
}

/// Balls of unknown colour in unknown cells of a ring go to where their colour goes.
std::string balls_in_a_ring(int balls, int cells) {
  std::string text = "types: ball, cell, colour constants: colour red, blue, green; cell c0";
  for (int i = 1; i < cells; ++i) text += ", c" + std::to_string(i);
  text += "; ball o0";
  for (int i = 1; i < balls; ++i) text += ", o" + std::to_string(i);
  text +=
      " predicates: in(ball, cell), of(ball, colour), goes(colour, cell), at(cell), next(cell, "
      "cell), held(ball), gone(ball) closed: at, next, held, gone, goes "
      "init: K(at(c0)) K(goes(red, c0)) K(goes(blue, c2)) K(goes(green, c4)) ";
  const auto any = [&](const std::string& atom, const std::vector<std::string>& values) {
    text += "Kx(";
    for (const std::string& v : values) text += (v == values[0] ? "" : " | ") + atom + v + ")";
    text += ") ";
  };
  std::vector<std::string> names;
  for (int i = 0; i < cells; ++i) {
    names.push_back("c" + std::to_string(i));
    const std::string here = "c" + std::to_string(i);
    const std::string there = "c" + std::to_string((i + 1) % cells);
    text += "K(next(" + here + ", " + there + ")) K(next(" + there + ", " + here + ")) ";
  }
  for (int i = 0; i < balls; ++i) {
    any("in(o" + std::to_string(i) + ", ", names);
    any("of(o" + std::to_string(i) + ", ", {"red", "blue", "green"});
  }
  return text +
         "action look(?o : ball, ?c : cell) preconds: K(at(?c)) effects: add(Kw, in(?o, ?c)) "
         "action inspect(?o : ball, ?k : colour) preconds: K(held(?o)) effects: add(Kw, of(?o, "
         "?k)) action go(?c : cell, ?d : cell) preconds: K(at(?c)) & K(next(?c, ?d)) effects: "
         "add(Kf, !at(?c)), add(Kf, at(?d)) action take(?o : ball, ?c : cell) preconds: K(at(?c)) "
         "& K(in(?o, ?c)) effects: add(Kf, held(?o)), add(Kf, !in(?o, ?c)) action drop(?o : ball, "
         "?k : colour, ?c : cell) preconds: K(held(?o)) & K(of(?o, ?k)) & K(goes(?k, ?c)) & "
         "K(at(?c)) effects: add(Kf, gone(?o)) goal: forallK(?o : ball) K(gone(?o))";
}

TEST(Beliefs, OneGoalAfterTheOtherKeepsPlansSmall) {
  const Model m = model_of(balls_in_a_ring(5, 8));
  const Solution s = solved(m, Algorithm::Greedy);
  EXPECT_EQ(s.outcome, Outcome::Solved);
  EXPECT_LE(measure(m, s.plan).nodes, 500U);
}

TEST(Beliefs, PlansCutShortAreRefuted) {
  const Model m = pddl(lost_in_a_ring(4));
  const Plan plan = solved(m, Algorithm::Greedy).plan;
  int refuted = 0;
  for (Index n = 0; n < plan.nodes.size(); ++n) {
    if (plan.nodes[n].branches || plan.nodes[n].next == kNone) continue;
    Plan shorter = plan;
    shorter.nodes[n].next = kNone;
    EXPECT_FALSE(check(m, shorter).valid) << n;
    ++refuted;
  }
  EXPECT_GT(refuted, 3);
}

TEST(Beliefs, WhatTheLanguageSays) {
  const auto says = [](const std::string& message, const char* words) {
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  says(complaint("predicates: p, q action a preconds: true effects: add(Or, p | q) goal: K(p)"),
       "initial entry");
  says(complaint("predicates: p, q action a preconds: true effects: whenever K(p) xor K(q) => "
                 "add(Kf, p) goal: K(p)"),
       "condition of the world");
  says(complaint("predicates: p, q init: Or(p | q)  K(!p) K(!q) goal: K(p)", ExternalBindings{}),
       "contradicts itself");
  says(complaint("(define (domain d) (:predicates (p) (q)) (:action a :observe (p)))"
                 "(define (problem x) (:domain d) (:init (oneof (and (p) (q)) (p))) "
                 "(:goal (p)))",
                 Language::Pddl),
       "'and' inside (oneof");
}

/// What only leads on by the agent's conditions, or by one of many values, is no dead end.
TEST(Beliefs, ConditionsOfTheAgentAndLongRangesLeadOn) {
  const Model conditional = model_of(
      "predicates: p, q, g\ninit: K(!g) Kx(p | q)\naction look preconds: true effects: add(Kw, p)\n"
      "action act preconds: true effects: K(p) => add(Kf, g), K(q) => add(Kf, g)\ngoal: K(g)");
  const Solution s = solved(conditional, Algorithm::Greedy);
  ASSERT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(measure(conditional, s.plan).leaves, 2U);
  std::string text = "types: v\nconstants: v v0";
  for (int i = 1; i < 40; ++i) text += ", v" + std::to_string(i);
  text +=
      "\npredicates: p, q, g\nfunctions: f : v\ninit: K(!g) Kx(p | q)\n"
      "action see preconds: true effects: add(Kv, f)\n"
      "action look preconds: Kv(f) effects: add(Kw, p)\n"
      "action win(?x : v) preconds: K(f = ?x) & K(p) effects: add(Kf, g)\n"
      "action lose(?x : v) preconds: K(f = ?x) & K(q) effects: add(Kf, g)\ngoal: K(g)";
  EXPECT_EQ(solved(model_of(text), Algorithm::Greedy).outcome, Outcome::Solved);
}

}  // namespace
}  // namespace kaboum::plan::test
