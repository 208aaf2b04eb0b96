// Derived predicates: their meaning, what is refused, and random tasks against a search that
// evaluates the rules itself.
#include <kaboum/plan/plan.h>

#include "derived_task.h"
#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

Model pddl_model(const std::string& text) {
  return load({"t.pddl", text, Language::Pddl}, nullptr);
}

std::uint64_t fewest(const Model& m) {
  const Solution s = solved(m, Algorithm::BreadthFirst);
  EXPECT_EQ(s.outcome, Outcome::Solved);
  for (const Algorithm a : kAll) EXPECT_EQ(solved(m, a).outcome, Outcome::Solved);
  return measure(m, s.plan).longest;
}

/// Doors between rooms in a row are opened; what can be reached is derived.
std::string rooms(int count, const std::string& goal, const std::string& more = "") {
  std::string objects, facts;
  for (int i = 0; i < count; ++i) {
    objects += " r" + std::to_string(i);
    if (i + 1 < count) facts += " (door r" + std::to_string(i) + " r" + std::to_string(i + 1) + ")";
  }
  return "(define (domain rooms) (:requirements :adl :derived-predicates)\n"
         " (:predicates (door ?x ?y) (open ?x ?y) (start ?x) (near ?x) (shut))\n"
         " (:derived (near ?x) (or (start ?x) (exists (?y) (and (near ?y) (open ?y ?x)))))\n"
         " (:derived (shut) (exists (?x) (not (near ?x))))\n" +
         more +
         " (:action unlock :parameters (?x ?y) :precondition (and (door ?x ?y) (near ?x))\n"
         "  :effect (open ?x ?y))\n"
         " (:action lock :parameters (?x ?y) :precondition (open ?x ?y)\n"
         "  :effect (not (open ?x ?y))))\n"
         "(define (problem p) (:domain rooms) (:objects" +
         objects + ")\n (:init (start r0)" + facts + ") (:goal " + goal + "))";
}

TEST(Derived, RecursiveRulesAreALeastFixedPoint) {
  EXPECT_EQ(fewest(pddl_model(rooms(4, "(near r3)"))), 3U);
  EXPECT_EQ(fewest(pddl_model(rooms(4, "(not (shut))"))), 3U);
  EXPECT_EQ(fewest(pddl_model(rooms(4, "(and (near r2) (shut))"))), 2U);
  // Two rooms that only reach one another are not near.
  const std::string island = rooms(2, "(near a)");
  std::string text = island;
  text.replace(text.find(" (start r0)"), 11, " (start r0) (open a b) (open b a)");
  text.replace(text.find("(:objects"), 9, "(:objects a b");
  EXPECT_EQ(solved(pddl_model(text), Algorithm::BreadthFirst).outcome, Outcome::Unsolvable);
  EXPECT_EQ(solved(pddl_model(text), Algorithm::Greedy).outcome, Outcome::Unsolvable);
}

TEST(Derived, WhatWasLookedAtTooEarlyIsLookedAtAgain) {
  // b rests on a, and is first asked for while a is not decided yet.
  const Model m = pddl_model(
      "(define (domain d) (:requirements :adl :derived-predicates) (:predicates (x) (c) (r) (a) "
      "(b))"
      " (:derived (r) (and (a) (b))) (:derived (a) (or (b) (c))) (:derived (b) (a))"
      " (:derived (a) (and (x) (r)))"
      " (:action f :parameters () :precondition (not (c)) :effect (and (c) (x))))"
      "(define (problem p) (:domain d) (:init (c)) (:goal (r)))");
  EXPECT_TRUE(check(m, Plan{}).valid);
  EXPECT_EQ(fewest(m), 0U);
}

TEST(Derived, LongChainsOfRulesAreFollowed) {
  constexpr int kRooms = 1500;
  std::string objects, facts;
  for (int i = 0; i < kRooms; ++i) {
    objects += " r" + std::to_string(i);
    if (i + 1 < kRooms)
      facts += " (next r" + std::to_string(i) + " r" + std::to_string(i + 1) + ")";
  }
  const Model m = pddl_model(
      "(define (domain d) (:requirements :adl :derived-predicates)"
      " (:predicates (next ?x ?y) (start ?x) (near ?x))"
      " (:derived (near ?x) (or (start ?x) (exists (?y) (and (next ?y ?x) (near ?y)))))"
      " (:action enter :parameters (?x) :precondition (not (near ?x)) :effect (start ?x)))"
      "(define (problem p) (:domain d) (:objects" +
      objects + ") (:init" + facts + ") (:goal (near r1499)))");
  const Solution s = solved(m, Algorithm::Greedy);
  ASSERT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(measure(m, s.plan).longest, 1U);
  Plan first = s.plan;
  first.nodes[0].action.arguments = {0};
  EXPECT_TRUE(check(m, first).valid);
}

/// What `check` follows is bounded by the depth of conditions, not of rules alone.
TEST(Derived, DeepRulesAreFollowedOrRefused) {
  std::string nested, closing, predicates, rules;
  for (int i = 0; i < 100; ++i) nested += "(and (x) ", closing += ")";
  for (int i = 1; i < 580; ++i) {
    const std::string n = std::to_string(i);
    predicates += " (p" + n + ")";
    rules +=
        " (:derived (p" + n + ") " + nested + "(p" + std::to_string(i - 1) + ")" + closing + ")";
  }
  const Model m = pddl_model(
      "(define (domain d) (:requirements :adl :derived-predicates) (:predicates (x) (p0)" +
      predicates + ")" + rules +
      " (:action f :parameters () :precondition (not (p0)) :effect (p0)))"
      "(define (problem p) (:domain d) (:init (x)) (:goal (p579)))");
  const Solution s = solve(m, {});
  ASSERT_EQ(s.outcome, Outcome::Solved);
  try {
    EXPECT_TRUE(check(m, s.plan).valid);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::LimitReached) << e.what();
  }
}

/// Derived atoms of a goal are worked out together: a round for each took 20 s for 400 of them.
TEST(Derived, ManyAtomsOfAGoalAreWorkedOutTogether) {
  constexpr int kSide = 16;
  std::string objects, facts;
  const auto cell = [](int x, int y) { return "c" + std::to_string(x) + "x" + std::to_string(y); };
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y) {
      objects += " " + cell(x, y);
      if (x + 1 < kSide) facts += " (next " + cell(x + 1, y) + " " + cell(x, y) + ")";
      if (y + 1 < kSide) facts += " (next " + cell(x, y + 1) + " " + cell(x, y) + ")";
    }
  const Model m = pddl_model(
      "(define (domain d) (:requirements :adl :derived-predicates)"
      " (:predicates (next ?x ?y) (at ?x) (reach ?x))"
      " (:derived (reach ?x) (or (at ?x) (exists (?y) (and (next ?y ?x) (reach ?y))))))"
      "(define (problem p) (:domain d) (:objects" +
      objects + ") (:init (at " + cell(kSide - 1, kSide - 1) + ")" + facts +
      ") (:goal (forall (?x) (reach ?x))))");
  EXPECT_TRUE(check(m, Plan{}).valid);
}

TEST(Derived, RulesOfOneAnotherAndOfASubtype) {
  // Even and odd steps from the start; only what is a place has an odd distance.
  const auto text = [](const std::string& goal) {
    return "(define (domain d) (:requirements :adl :derived-predicates) (:types place - object)"
           " (:predicates (next ?x ?y) (even ?x) (odd ?x) (done))"
           " (:derived (even ?x) (exists (?y) (and (next ?y ?x) (odd ?y))))"
           " (:derived (even ?x) (= ?x a))"
           " (:derived (odd ?x - place) (exists (?y) (and (next ?y ?x) (even ?y))))"
           " (:action link :parameters (?x ?y) :precondition (not (= ?x ?y))"
           "  :effect (and (next ?x ?y) (when (odd ?y) (done)))))"
           "(define (problem p) (:domain d) (:objects a b - object c d - place) (:init)"
           " (:goal " +
           goal + "))";
  };
  EXPECT_EQ(fewest(pddl_model(text("(odd d)"))), 1U);
  EXPECT_EQ(fewest(pddl_model(text("(even d)"))), 2U);
  EXPECT_EQ(fewest(pddl_model(text("(and (done) (odd c))"))), 2U)
      << "conditions read the state before";
  EXPECT_EQ(solved(pddl_model(text("(odd b)")), Algorithm::Greedy).outcome, Outcome::Unsolvable);
}

TEST(Derived, LargeRulesHaveAtomsOfTheirOwn) {
  // All pairs are linked or equal: as a formula some thousand nodes, needed by another rule.
  std::string objects;
  for (int i = 0; i < 40; ++i) objects += " x" + std::to_string(i);
  const Model m = pddl_model(
      "(define (domain d) (:requirements :adl :derived-predicates)"
      " (:predicates (on ?x) (every) (nothing) (mixed) (go))"
      " (:derived (every) (forall (?x ?y) (or (= ?x ?y) (and (on ?x) (on ?y)))))"
      " (:derived (nothing) (forall (?x ?y) (or (= ?x ?y) (and (not (on ?x)) (not (on ?y))))))"
      " (:derived (mixed) (and (not (every)) (not (nothing))))"
      " (:action start :parameters () :precondition (nothing) :effect (on x0))"
      " (:action up :parameters (?x) :precondition (mixed) :effect (and (on ?x) (go)))"
      " (:action jump :parameters () :precondition (mixed) :effect (forall (?x) (on ?x))))"
      "(define (problem p) (:domain d) (:objects" +
      objects + ") (:init) (:goal (and (every) (go))))");
  for (const Algorithm a : {Algorithm::BreadthFirst, Algorithm::Greedy, Algorithm::AStar}) {
    const Solution s = solved(m, a);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    if (a != Algorithm::Greedy) {
      EXPECT_EQ(measure(m, s.plan).longest, 3U);
    }
  }
}

TEST(Derived, ConvertedToPddlAgainAndToNothingElse) {
  const std::string text = rooms(3, "(not (shut))");
  const Text domain{"rooms.pddl", text, Language::Pddl};
  const std::string again = convert(domain, nullptr, Language::Pddl);
  EXPECT_NE(again.find("(:derived (near ?x - object)"), std::string::npos);
  EXPECT_EQ(fewest(pddl_model(again)), 2U);
  try {
    convert(domain, nullptr, Language::Kpl);
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("cannot say"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("derived predicates ('near')"), std::string::npos);
  }
}

TEST(Derived, RefusedWithFileAndLine) {
  const auto refused = [](const std::string& more, const std::string& why) {
    const std::string said = complaint(rooms(2, "(near r1)", more), Language::Pddl);
    EXPECT_NE(said.find(why), std::string::npos) << said;
    EXPECT_EQ(said.rfind("bad.pddl:", 0), 0U) << said;
  };
  refused("(:derived (open ?x ?y) (and (door ?x ?y) (not (near ?y))))\n",
          "error: 'open' depends on the negation of 'near', which depends on it: rules are not "
          "stratified, which is not supported");
  refused("(:derived (start ?x) (not (start ?x)))\n",
          "error: 'start' depends on the negation of 'start', which depends on it");
  refused("(:action f :parameters (?x) :precondition () :effect (near ?x))\n",
          "error: 'near' is derived by rules: no effect and no initial entry can set it");
  refused("(:derived (start ?x) (= ?x r1))\n", "error: 'start' is derived by rules: no effect and");
  refused("(:derived (gone ?x) (start ?x))\n", "error: unknown predicate 'gone'");
  refused("(:derived (near ?x ?y) (start ?x))\n", "error: 'near' takes 1 argument, not 2");
  refused("(:derived (near r0) (start r0))\n", "error: expected a variable such as ?x");
  refused("(:derived (open ?x ?x) (start ?x))\n", "error: parameter '?x' is declared twice");
  refused("(:derived (near ?x) (start ?y))\n", "error: unknown variable '?y'");
  refused("(:derived (near ?x) (start ?x) (start ?x))\n",
          "error: a rule has one condition: use (and ...)");
  refused("(:derived (near ?x))\n", "error: expected a condition");
  refused("(:action look :parameters (?x) :observe (start ?x))\n",
          "error: derived predicates need complete knowledge: nothing unknown, sensed or given up, "
          "and no external functions");
  std::string open = rooms(2, "(near r1)");
  open.replace(open.find(":derived-predicates"), 19, ":derived-predicates :contingent");
  EXPECT_NE(complaint(open, Language::Pddl), "bad.pddl");  // nothing is unknown: it is taken
  EXPECT_EQ(complaint(open, Language::Pddl), "no error");
  open.replace(open.find("(start r0)"), 10, "(oneof (start r0) (start r1))");
  EXPECT_NE(complaint(open, Language::Pddl).find("derived predicates need complete knowledge"),
            std::string::npos);
  // A kpl problem of a PDDL domain has to be closed, and cannot ask what is known of them.
  const std::string text = rooms(2, "(near r1)");
  const Text domain{"d.pddl", text.substr(0, text.find("(define (problem")), Language::Pddl};
  const auto with = [&](const std::string& kpl) -> std::string {
    const Text problem{"p.kpl", "constants: r0, r1\ninit: K(start(r0)), K(door(r0, r1))\n" + kpl,
                       Language::Kpl};
    try {
      EXPECT_EQ(fewest(load(domain, &problem)), 1U);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(with("closed: all\ngoal: K(near(r1)) & !K(!near(r0)) & K(!shut)"), "");
  EXPECT_NE(with("predicates: all\nclosed: all\ngoal: K(near(r1))").find("need complete knowledge"),
            std::string::npos);
  EXPECT_NE(with("functions: f : object\nclosed: all\ngoal: K(near(r1))")
                .find("the initial state has no value of 'f' for some arguments"),
            std::string::npos);
  EXPECT_EQ(with("functions: f : object\ninit: K(f = r0)\nclosed: all\ngoal: K(near(r1))"), "");
  EXPECT_NE(with("goal: K(near(r1))").find("need complete knowledge"), std::string::npos);
  EXPECT_NE(with("closed: all\ngoal: Kw(near(r1))").find("'near' is derived: it is always known"),
            std::string::npos);
}

/// The verdict and the fewest steps, with each search; and what `check` says of any steps.
TEST(Derived, RandomTasksAsAnExhaustiveSearchDecidesThem) {
  int solvable = 0, unsolvable = 0, recursive = 0, valid = 0, invalid = 0;
  for (std::uint32_t seed = 1; seed <= 1000; ++seed) {
    const DerivedTask task(seed);
    const std::optional<std::optional<std::uint64_t>> truth = task.fewest_steps(600);
    if (!truth) continue;
    const std::string text = task.pddl();
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + text);
    const Model m = pddl_model(text);
    for (const Symbol& p : m.predicates) recursive += p.recursive ? 1 : 0;
    ++(*truth ? solvable : unsolvable);
    for (const Algorithm a : kAll) {
      const Solution s = solved(m, a);
      ASSERT_EQ(s.outcome, *truth ? Outcome::Solved : Outcome::Unsolvable);
      if (*truth && a != Algorithm::Greedy && a != Algorithm::DepthFirst) {
        ASSERT_EQ(measure(m, s.plan).longest, **truth);
      }
    }
    std::mt19937 random(seed);
    for (int i = 0; i < 20; ++i) {
      Plan plan;
      std::vector<DerivedTask::Step> steps;
      for (std::uint32_t n = random() % 4; n > 0; --n) steps.push_back(task.any_step(random));
      for (const DerivedTask::Step& s : steps) {
        Plan::Node node;
        node.acts = true;
        node.action = {static_cast<Index>(s.action), {s.arguments.begin(), s.arguments.end()}};
        node.next = static_cast<Index>(plan.nodes.size() + 1);
        plan.nodes.push_back(node);
      }
      if (!steps.empty()) {
        plan.root = 0;
        plan.nodes.back().next = kNone;
      }
      const bool expected = task.is_plan(steps);
      ++(expected ? valid : invalid);
      ASSERT_EQ(check(m, plan).valid, expected);
    }
  }
  EXPECT_GT(solvable, 240);
  EXPECT_GT(unsolvable, 160);
  EXPECT_GT(recursive, 400);
  EXPECT_GT(valid, 800);
  EXPECT_GT(invalid, 800);
}

}  // namespace
}  // namespace kaboum::plan::test
