// Small tasks on which a careless planner or validator is wrong: false proofs of unsolvability,
// unsound inference, plans that fail at run time.
#include <chrono>
#include <set>

#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

void expect_all(const std::string& text, Outcome outcome) {
  const Model m = model_of(text);
  for (const Algorithm a : kAll)
    EXPECT_EQ(solved(m, a).outcome, outcome) << text << "\nsearch " << static_cast<int>(a);
}

Plan straight(const Model& m, std::initializer_list<const char*> names) {
  Plan p;
  for (const char* name : names) {
    Plan::Node n;
    n.acts = true;
    for (Index i = 0; i < m.actions.size(); ++i)
      if (m.actions[i].name == name) n.action.schema = i;
    n.next = static_cast<Index>(p.nodes.size() + 1);
    p.nodes.push_back(n);
  }
  p.nodes.back().next = kNone;
  p.root = 0;
  return p;
}

TEST(Soundness, ABranchMayBeNeededBeforeAnyTestReadsIt) {
  // Only one of left and right can be done; which is right is sensed, but nothing tests it before.
  expect_all(
      "predicates: p, q, r, used, done\ninit: K(!used) K(!done) Kw(p)\n"
      "action left preconds: K(!used) effects: add(Kf, q), add(Kf, used)\n"
      "action right preconds: K(!used) effects: add(Kf, r), add(Kf, used)\n"
      "action finish1 preconds: K(q) & K(p) effects: add(Kf, done)\n"
      "action finish2 preconds: K(r) & K(!p) effects: add(Kf, done)\n"
      "goal: K(done)",
      Outcome::Solved);
  // The same with the goal as the only test, and with a sensed value.
  expect_all(
      "types: v\nconstants: v a, b\nfunctions: f : v\npredicates: q, r, used\n"
      "init: K(!used) Kv(f)\n"
      "action left preconds: K(!used) effects: add(Kf, q), add(Kf, used)\n"
      "action right preconds: K(!used) effects: add(Kf, r), add(Kf, used)\n"
      "goal: (K(q) & K(f = a)) | (K(r) & K(f = b))",
      Outcome::Solved);
}

TEST(Soundness, DeletingANegationLeavesWhatIsTrue) {
  // del(Kf, !p) takes nothing from a true p. An invariant that thinks so holds "p or q, not both"
  // for certain, and then the goal for impossible.
  expect_all(
      "types: v\nconstants: v a, b\npredicates: p(v), t\ninit: K(p(a)) K(!p(b)) K(!t)\n"
      "action shift(?x : v, ?y : v) preconds: K(p(?x)) & K(!p(?y)) effects: del(Kf, !p(?x)), "
      "add(Kf, p(?y))\n"
      "action tick preconds: K(p(a)) & K(p(b)) effects: add(Kf, t)\n"
      "goal: K(p(a)) & K(p(b)) & K(t)",
      Outcome::Solved);
}

TEST(Soundness, AnInvariantOfOneKeySaysNothingOfAnother) {
  // at(?x, .) has two places for box x at the start; the action that needs both gives y a second.
  expect_all(
      "types: box, place\nconstants: box x, y; place a, b\npredicates: at(box, place)\n"
      "init: K(at(x, a)) K(at(x, b)) K(at(y, a)) K(!at(y, b))\n"
      "action clone preconds: K(at(x, a)) & K(at(x, b)) effects: add(Kf, at(y, b))\n"
      "goal: K(at(y, a)) & K(at(y, b))",
      Outcome::Solved);
}

TEST(Soundness, AnUnknownTermInAnEffectTakesKnowledge) {
  // The box is moved to where the cart is, which is unknown: it may be anywhere then.
  const std::string head =
      "types: place\nconstants: place a, b\nfunctions: box : place; cart : place\n"
      "predicates: lit(place)\ninit: K(box = a) K(!lit(a)) K(!lit(b))\n"
      "action bring preconds: true effects: add(Kf, box = cart), add(Kf, lit(cart))\n"
      "action ask preconds: true effects: add(Kv, cart)\n";
  const Model m = model_of(head + "goal: K(box = a) & K(!lit(b))");
  EXPECT_FALSE(check(m, straight(m, {"bring"})).valid);
  expect_all(head + "goal: K(lit(a)) & K(box = a) & K(!lit(a))", Outcome::NotInferred);
  // After bring, box = a and !lit(b) are gone; asking first keeps one of them in each branch.
  const Model lost = model_of(head +
                              "action stop preconds: !K(box = a) & !K(!lit(a)) effects: "
                              "add(Kv, cart), add(Kv, box), add(Kw, lit(a))\n"
                              "goal: !Kw(lit(b)) & !Kw(lit(a))");
  EXPECT_TRUE(check(lost, straight(lost, {"bring"})).valid);
  for (const Algorithm a : kAll) EXPECT_EQ(solved(lost, a).outcome, Outcome::Solved);
}

TEST(Soundness, TheCheckerKeepsWhatALaterExclusiveOrNeeds) {
  const Model m = model_of(
      "predicates: f, g, x\ninit: K(f)\n"
      "action rest preconds: true effects: add(Kf, x)\n"
      "action tell preconds: K(x) effects: add(Kx, f | g)\ngoal: K(!g)");
  EXPECT_TRUE(check(m, straight(m, {"rest", "tell"})).valid);
  const Model hidden = model_of(
      "predicates: f, g, x\ninit: K(f)\n"
      "action rest preconds: true effects: add(Kf, x)\n"
      "action tell preconds: K(x) effects: add(Kx, f | g)\ngoal: !K(!g) & K(x)");
  EXPECT_FALSE(check(hidden, straight(hidden, {"rest", "tell"})).valid);
  for (const Algorithm a : kAll) EXPECT_EQ(solved(m, a).outcome, Outcome::Solved);
}

TEST(Soundness, AnObservationRulesOutWhatItContradicts) {
  // Both are sensed; then it is observed that exactly one holds: two outcomes are left, not four.
  const std::string text =
      "predicates: p, q, x\ninit: Kw(p) Kw(q) K(!x)\n"
      "action tell preconds: K(!x) effects: add(Kx, p | q), add(Kf, x)\n"
      "goal: K(x) & ((K(p) & K(!q)) | (K(!p) & K(q)))";
  expect_all(text, Outcome::Solved);
  const Model m = model_of(text);
  EXPECT_EQ(measure(m, solved(m, Algorithm::BreadthFirst).plan).leaves, 2U);
  // What contradicts certain knowledge cannot be observed: no step, so no plan.
  expect_all(
      "predicates: p, q, x\ninit: K(p) K(q) K(!x)\n"
      "action tell preconds: K(!x) effects: add(Kx, p | q), add(Kf, x)\ngoal: K(x)",
      Outcome::NotInferred);
}

TEST(Soundness, GivingUpADisjunctionWaitsForWhatItTells) {
  // c decides b, b decides a: once c is sensed, a may be known, and then !K(a) fails.
  expect_all(
      "predicates: a, b, c, e, x\ninit: Kx(a | b) Kx(b | c | e) K(!x)\n"
      "action look preconds: !Kw(c) effects: add(Kw, c)\n"
      "action drop preconds: Kw(c) effects: del(Kx, a | b), add(Kf, x)\n"
      "goal: K(x) & !K(a)",
      Outcome::Unsolvable);
}

TEST(Soundness, AClosedWorldDoesNotDecideADisjunction) {
  // "Exactly one of a and b" and "what is not stated is false" do not say which.
  const std::string text =
      "types: v\nconstants: v a, b\npredicates: p(v), x\ninit: Kx(p(a) | p(b)) LCW(p(?v))\n"
      "action none preconds: false effects: add(Kf, x)\n";
  expect_all(text + "goal: K(p(b)) | K(p(a))", Outcome::Unsolvable);
  expect_all(text + "goal: !Kw(p(b)) & !Kw(p(a))", Outcome::Solved);
}

TEST(Soundness, PddlAdditionsWin) {
  // (p) and (not (p)) of one action: p holds afterwards, in whatever order they are written.
  for (const char* effects : {"(and (on ?x) (not (on ?y)))", "(and (not (on ?y)) (on ?x))",
                              "(and (when (c) (on ?x)) (not (on ?y)))",
                              "(and (forall (?z - t) (when (c) (on ?z))) (not (on ?y)))"}) {
    const Model m = load(
        {"t.pddl",
         std::string("(define (domain d) (:requirements :adl) (:types t) (:predicates (on ?x - t) "
                     "(c) (done)) (:action touch :parameters (?x ?y - t) :precondition (not "
                     "(done)) :effect (and (done) ") +
             effects +
             ")))(define (problem p) (:domain d) (:objects a - t) (:init (c)) (:goal (and (done) "
             "(on a))))",
         Language::Pddl},
        nullptr);
    EXPECT_EQ(solved(m, Algorithm::BreadthFirst).outcome, Outcome::Solved) << effects;
  }
}

TEST(Soundness, PddlConditionsThatAreUnknownTakeKnowledge) {
  // Whether the box is open is unknown; shaking empties it if so: full is unknown then.
  const Model m =
      load({"t.pddl",
            "(define (domain d) (:requirements :adl :contingent) (:predicates (open) (full) (done))"
            " (:action shake :parameters () :effect (and (done) (when (open) (not (full)))))"
            " (:action look :parameters () :observe (open)))"
            "(define (problem p) (:domain d) (:init (full) (unknown (open))) (:goal (and (done) "
            "(full))))",
            Language::Pddl},
           nullptr);
  for (const Algorithm a : kAll) EXPECT_EQ(solved(m, a).outcome, Outcome::Unsolvable);
}

TEST(Soundness, CostsAreNotNegative) {
  const std::string text =
      "(define (domain d) (:requirements :action-costs) (:predicates (p)) (:functions (total-cost) "
      "- number (k) - number)"
      " (:action a :parameters () :effect (and (p) (increase (total-cost) COST))))"
      "(define (problem q) (:domain d) (:init (= (k) VALUE)) (:goal (p)))";
  for (const auto& [cost, value] : {std::pair("-3", "1"), std::pair("(k)", "-1")}) {
    std::string t = text;
    t.replace(t.find("COST"), 4, cost);
    t.replace(t.find("VALUE"), 5, value);
    EXPECT_NE(complaint(t, Language::Pddl).find("whole number"), std::string::npos)
        << complaint(t, Language::Pddl);
  }
}

TEST(Soundness, AHiddenStateIsRefused) {
  // A check finds a new state and hides it; an effect takes over what the last check left behind.
  std::string hidden;
  ExternalBindings bindings;
  bindings["check"] = [&](std::span<const std::string> a) { return hidden = a[0]; };
  bindings["current"] = [&](std::span<const std::string>) { return hidden; };
  bindings["currentOf"] = [&](std::span<const std::string>) { return hidden; };
  const std::string text =
      "types: v\nconstants: v a, b, c\nfunctions: s : v\npredicates: x\ninit: K(!x)\n"
      "goal: K(s = a)\n";
  const auto go = [](const std::string& current) {
    return "action go(?o : v) preconds: extern(check(?o)) effects: add(Kf, s = extern(" + current +
           "))";
  };
  EXPECT_NE(complaint(text + "externals: check(v); current : v\n" + go("current"), bindings)
                .find("t.kpl:7:22: error: external function 'current' has no arguments"),
            std::string::npos);
  EXPECT_NE(
      complaint(text + "externals: check(v); current : v volatile\n" + go("current"), bindings)
          .find("'volatile' functions depend on calls made before"),
      std::string::npos);
  EXPECT_NE(
      complaint(text + "externals: check(v); currentOf(v) : v\n" + go("currentOf(b)"), bindings)
          .find("external function 'currentOf(b)' returned another value"),
      std::string::npos);
}

TEST(Soundness, UnsolvableIsSaidOnlyWhereNothingIsLost) {
  // Each is solvable in the world, but not with what a state keeps.
  const std::string head = "predicates: a, b, p, q\ninit: K(!q)";
  const auto outcome = [](const std::string& text) {
    const Model m = model_of(text);
    std::set<Outcome> all;
    for (const Algorithm a : kAll) all.insert(solve(m, {a, 0, 0, {}}).outcome);
    EXPECT_EQ(all.size(), 1U) << text;
    return *all.begin();
  };
  const std::string both =
      "\naction go preconds: true effects: K(p) => add(Kf, q), K(!p) => "
      "add(Kf, q)\ngoal: K(q)";
  EXPECT_EQ(outcome(head + both), Outcome::NotInferred);
  EXPECT_EQ(outcome(head + ", K(p)" + both), Outcome::Solved);
  // What is known either way decides the effect: nothing is lost.
  EXPECT_EQ(outcome(head + ", Kw(p)\naction go preconds: true effects: K(p) => add(Kf, q)\n"
                           "goal: K(q)"),
            Outcome::Unsolvable);
  EXPECT_EQ(outcome(head + ", K(p)\naction go preconds: true effects: maybe(Kf, q)\ngoal: K(q)"),
            Outcome::Unsolvable);
  EXPECT_EQ(outcome("predicates: a, b, c\ninit: Kx(a | b | c), Kx(a | b)\n"
                    "action no preconds: false effects: add(Kf, a)\ngoal: K(!c)"),
            Outcome::Solved);
  EXPECT_EQ(outcome(head +
                    ", K(p)\naction go preconds: true effects: add(Kf, a)\n"
                    "action undo preconds: true effects: del(Kf, p)\n" +
                    std::string("action end preconds: true effects: K(p) => add(Kf, b)\n") +
                    "goal: K(q)"),
            Outcome::NotInferred);
  // Plain classical tasks lose nothing, conditional effects or not.
  EXPECT_EQ(outcome("predicates: p, q\nclosed: p, q\ninit: K(p)\n"
                    "action go preconds: true effects: K(!p) => add(Kf, q)\ngoal: K(q)"),
            Outcome::Unsolvable);
}

TEST(Soundness, TimeAndMemoryLimitsHoldWhileGrounding) {
  std::string constants;
  for (int i = 0; i < 60; ++i) constants += (i ? ", c" : "c") + std::to_string(i);
  std::string wide =
      "constants: object " + constants + "\npredicates: p(object, object), x\n" +
      "action wide(?a : object, ?b : object, ?c : object, ?d : object, ?e : object, ?f : object) "
      "preconds: !K(p(?a, ?b)) & !K(p(?b, ?c)) & !K(p(?c, ?d)) & !K(p(?d, ?e)) & !K(p(?e, ?f)) "
      "effects: add(Kf, p(?a, ?f))\naction no preconds: false effects: add(Kf, x)\ngoal: K(x)";
  const Model m = model_of(wide);
  for (const Algorithm a : kAll) {
    SolveOptions o;
    o.algorithm = a;
    o.timeout = 0.3;
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(solve(m, o).outcome, Outcome::Limit);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 3);
    o.timeout = 0;
    o.max_memory = 16U << 20U;
    const Solution s = solve(m, o);
    EXPECT_EQ(s.outcome, Outcome::Limit);
    EXPECT_NE(s.limit.find("memory"), std::string::npos);
  }
}

}  // namespace
}  // namespace kaboum::plan::test
