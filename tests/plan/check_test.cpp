// The validator, and whether it notices damage done to good plans.
#include <random>

#include "damaged_plan.h"
#include "plan_test.h"
#include "possible_worlds.h"
#include "random_model.h"
#include "works_merged.h"

namespace kaboum::plan::test {
namespace {

Plan good_plan(const Model& m) { return solved(m, Algorithm::BreadthFirst).plan; }

bool valid(const Model& m, const Plan& p) {
  try {
    return check(m, p).valid;
  } catch (const Error&) {
    return false;  // a cycle
  }
}

TEST(Check, SkippingAnyActionIsNoticed) {
  for (const char* name : {"stacked", "force-sensing", "bartender", "bimanual-assembly"}) {
    const Model m = scenario(name, name == std::string("stacked") ? "4" : "1");
    const Plan plan = good_plan(m);
    ASSERT_TRUE(valid(m, plan));
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      if (plan.nodes[i].branches) continue;
      Plan broken = plan;
      const Index after = plan.nodes[i].next;
      for (Plan::Node& n : broken.nodes) {
        if (!n.branches && n.next == i) n.next = after;
        for (Plan::Branch::Case& c : n.branch.cases)
          if (c.next == i) c.next = after;
      }
      if (broken.root == i) broken.root = after;
      EXPECT_FALSE(valid(m, broken))
          << name << ": without " << action_text(m, plan.nodes[i].action);
    }
  }
}

TEST(Check, EndingEarlyIsNoticed) {
  const Model m = scenario("bartender", "2");
  const Plan plan = good_plan(m);
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (!plan.nodes[i].branches && plan.nodes[i].next != kNone) {
      Plan broken = plan;
      broken.nodes[i].next = kNone;
      EXPECT_FALSE(valid(m, broken));
    }
  }
}

TEST(Check, ExchangingOrDroppingCasesIsNoticed) {
  for (const char* name : {"force-sensing", "bartender"}) {
    const Model m = scenario(name, "2");
    const Plan plan = good_plan(m);
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      if (!plan.nodes[i].branches) continue;
      Plan swapped = plan;
      std::swap(swapped.nodes[i].branch.cases[0].next, swapped.nodes[i].branch.cases[1].next);
      EXPECT_FALSE(valid(m, swapped)) << name;
      for (std::size_t c = 0; c < plan.nodes[i].branch.cases.size(); ++c) {
        Plan dropped = plan;
        dropped.nodes[i].branch.cases.erase(dropped.nodes[i].branch.cases.begin() +
                                            static_cast<std::ptrdiff_t>(c));
        EXPECT_FALSE(valid(m, dropped)) << name;
      }
    }
  }
}

TEST(Check, BranchingWithoutSensingIsNoticed) {
  const Model m = scenario("force-sensing", "1");
  Plan plan = good_plan(m);
  for (Plan::Node& n : plan.nodes)
    if (n.branches) n.acts = false;  // the branch stays, the weighing goes
  const CheckResult r = check(m, plan);
  EXPECT_FALSE(r.valid);
  EXPECT_NE(r.violation.find("not known"), std::string::npos) << r.violation;
}

TEST(Check, OtherArgumentsAreNoticed) {
  const Model m = scenario("stacked", "4");
  const Plan plan = good_plan(m);
  int noticed = 0;
  int tried = 0;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)
    for (Index o = 0; o < m.objects.size(); ++o) {
      Plan broken = plan;
      if (broken.nodes[i].action.arguments[1] == o) continue;
      broken.nodes[i].action.arguments[1] = o;
      ++tried;
      noticed += valid(m, broken) ? 0 : 1;
    }
  EXPECT_EQ(noticed, tried);  // the shortest plan of STACKED has no slack
}

TEST(Check, ACycleIsRefused) {
  const Model m = scenario("stacked", "3");
  Plan plan = good_plan(m);
  plan.nodes.back().next = plan.root;
  for (Plan::Node& n : plan.nodes)
    if (n.next == kNone) n.next = plan.root;
  EXPECT_THROW(check(m, plan), Error);
}

/// Good plans of random models, damaged in every way there is: the validator and the sets of worlds
/// must agree, whether the damage matters or not.
TEST(Check, AgreesWithSetsOfWorldsOnDamagedPlans) {
  std::mt19937 random(1);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int refused = 0;
  int accepted = 0;
  for (std::uint32_t seed = 0; seed < 500 && !HasFailure(); ++seed) {
    const std::string text = Generator(seed + 500'000, false).model(5, 0);
    const Model m = model_of(text);
    Solution s;
    try {
      s = solve(m, {seed % 2 ? Algorithm::DepthFirst : Algorithm::BreadthFirst, 2, 0, {}});
    } catch (const Error&) {
      continue;  // the initial knowledge contradicts itself
    }
    if (s.outcome != Outcome::Solved || s.plan.root == kNone) continue;
    ASSERT_TRUE(valid(m, s.plan)) << text;
    ASSERT_TRUE(valid_in_worlds(m, s.plan)) << text;
    for (int i = 0; i < 12; ++i) {
      const Plan p = damaged(m, s.plan, 1 + pick(2), random);
      bool cycle = false;
      try {
        measure(m, p);
      } catch (const Error&) {
        cycle = true;
      }
      if (cycle) {
        EXPECT_THROW(check(m, p), Error);
        continue;
      }
      const bool expected = valid_in_worlds(m, p);
      EXPECT_EQ(valid(m, p), expected) << "seed " << seed << "\n" << text << plan_text(m, p);
      ++(expected ? accepted : refused);
    }
  }
  EXPECT_GT(refused, 200);
  EXPECT_GT(accepted, 100);
}

/// n balls are each in one of three cells. Each is looked for in the first cell for nothing, then
/// all are looked for and taken.
Plan looks_twice(const Model& m, Index n) {
  const auto object = [&](const std::string& name) {
    return static_cast<Index>(std::ranges::find(m.objects, name, &Object::name) -
                              m.objects.begin());
  };
  Plan p;
  const auto act = [&](Index schema, Index ball, const char* cell) -> Plan::Node& {
    p.nodes.emplace_back();
    p.nodes.back().acts = true;
    p.nodes.back().action = {schema, {object("o" + std::to_string(ball)), object(cell)}};
    return p.nodes.back();
  };
  const auto look = [&](Index ball, const char* cell, Index found, Index not_found) {
    Plan::Node& node = act(0, ball, cell);
    node.branches = true;
    node.branch.symbol = 0;
    node.branch.arguments = node.action.arguments;
    node.branch.cases = {{0, not_found}, {1, found}};
  };
  for (Index i = 0; i < n; ++i) look(i, "a", i + 1, i + 1);
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<Index>(p.nodes.size());
    look(i, "a", at + 1, at + 2);
    act(1, i, "a").next = i + 1 < n ? at + 5 : kNone;
    look(i, "b", at + 3, at + 4);
    act(1, i, "b").next = i + 1 < n ? at + 5 : kNone;
    act(1, i, "c").next = i + 1 < n ? at + 5 : kNone;
  }
  p.root = 0;
  return p;
}

TEST(Check, RunsThatMeetAreReplayedAtOnceWhereTheyAreMany) {
  constexpr Index n = 18;
  std::string text = "types: ball, cell constants: cell a, b, c; ball o0";
  for (Index i = 1; i < n; ++i) text += ", o" + std::to_string(i);
  text += " predicates: in(ball, cell), taken(ball) closed: taken init: ";
  for (Index i = 0; i < n; ++i) {
    const std::string o = "in(o" + std::to_string(i) + ", ";
    text += "Kx(" + o + "a) | " + o + "b) | " + o + "c)) ";
  }
  text +=
      "action look(?o : ball, ?c : cell) preconds: true effects: add(Kw, in(?o, ?c)) "
      "action take(?o : ball, ?c : cell) preconds: K(in(?o, ?c)) effects: add(Kf, taken(?o)) "
      "goal: forallK(?o : ball) K(taken(?o))";
  const Model m = model_of(text);
  Plan plan = looks_twice(m, n);
  const CheckResult r = check(m, plan, 50'000);
  EXPECT_TRUE(r.valid) << r.violation;
  EXPECT_TRUE(works_merged(m, plan));
  for (const char* cell : {"b", "c"}) {  // where the last ball is not, and may be
    std::swap(plan.nodes.back().action.arguments.back(),
              plan.nodes[plan.nodes.size() - 2].action.arguments.back());
    EXPECT_EQ(works_merged(m, plan), *cell == 'c');
  }
}

/// All bottles are looked at first; of each it matters later whether it is empty, and nothing of
/// those that are done with.
TEST(Check, NodesAreReplayedAFewTimesEach) {
  for (const char* n : {"4", "12"}) {
    const Model m = scenario("bartender", n);
    const Plan plan = solved(m, Algorithm::Greedy).plan;
    const CheckResult r = check(m, plan);
    EXPECT_TRUE(r.valid) << r.violation;
    EXPECT_LE(r.states, 2 * plan.nodes.size());
    EXPECT_EQ(r.leaves, 1);
  }
}

/// What is known of p differs, and the condition holds either way; then one of the ways fails.
TEST(Check, AConditionThatHoldsMayFailFurtherDown) {
  const auto verdict = [](const std::string& spoil, const std::string& one) {
    const Model m = model_of(
        "predicates: p, q, s, done\ninit: K(!p), K(!q)\naction look effects: add(Kw, s)\n"
        "action one preconds: K(s) effects: " +
        one +
        "\naction two preconds: K(!s) effects: add(Kf, p)\n"
        "action act effects: add(Kf, done)" +
        spoil + "\naction rest preconds: K(p) | K(q) effects: \ngoal: K(done) & (K(p) | K(q))");
    const Plan plan =
        read_plan(m,
                  R"({"format":"kaboum-plan","version":1,"domain":"","root":0,"nodes":[
      {"action":"look","arguments":[],"branch":{"predicate":"s","arguments":[],
        "cases":[{"value":true,"next":1},{"value":false,"next":2}]}},
      {"action":"one","arguments":[],"next":3},{"action":"two","arguments":[],"next":3},
      {"action":"act","arguments":[],"next":4},{"action":"rest","arguments":[],"next":"goal"}]})",
                  "plan.json");
    return check(m, plan);
  };
  const CheckResult good = verdict("", "add(Kf, q)");
  EXPECT_TRUE(good.valid) << good.violation;
  EXPECT_EQ(good.states, 6);  // each node once, and the end
  EXPECT_FALSE(verdict(", add(Kf, !p)", "add(Kf, q)").valid);
  EXPECT_FALSE(verdict(", add(Kf, !q)", "add(Kf, q)").valid);
  EXPECT_FALSE(verdict("", "del(Kf, !q)").valid);  // neither is known then
}

/// f is sensed, a fact that is tied to another one is, and f again: f is open all the while.
TEST(Check, WhatIsSensedTwiceInOneStepIsDoneOnce) {
  const auto verdict = [](const std::string& text) {
    const Model m = model_of("types: t, bottle\nconstants: t a, b; bottle x, y\n" + text);
    return check(m, read_plan(m,
                              R"({"format":"kaboum-plan","version":1,"domain":"","root":0,"nodes":[
      {"action":"look","arguments":[],"next":"goal"}]})",
                              "plan.json"));
  };
  const std::string sensed_for_all =
      "predicates: p(bottle), q, g\nfunctions: f : t\naction look effects: forall(?o : bottle) "
      "(add(Kv, f), add(Kw, p(?o)))\ninit: Kx(p(x) | q)\n";
  EXPECT_FALSE(verdict(sensed_for_all + "goal: K(q)").valid);
  EXPECT_TRUE(verdict(sensed_for_all + "goal: Kw(q) & Kv(f)").valid);
  const std::string facts = "predicates: p, q, g\nfunctions: f : t\n";
  const std::string twice =
      facts +
      "action look effects: add(Kv, f), add(Kw, p), add(Kv, f), K(f = a) => add(Kf, g), "
      "K(f = b) => add(Kf, g)\ninit: Kx(p | q)\n";
  EXPECT_FALSE(verdict(twice + "goal: K(g) & Kw(p)").valid);  // f was not known before
  EXPECT_TRUE(verdict(twice + "goal: Kw(p) & Kv(f)").valid);
  EXPECT_TRUE(verdict(facts +
                      "action look effects: add(Kf, g)\ninit: Kx(p | q), Kv(f), Kw(p), Kv(f)\n"
                      "goal: K(g) & Kw(p) & Kv(f)")
                  .valid);
}

TEST(Check, TreeAndGraphAreBothValid) {
  const Model m = scenario("bartender", "3");
  const Plan plan = good_plan(m);
  const Plan tree = expand_tree(plan);
  EXPECT_TRUE(valid(m, tree));
  EXPECT_EQ(measure(m, tree).tree_actions, measure(m, plan).tree_actions);
  EXPECT_GT(measure(m, tree).nodes, measure(m, plan).nodes);
}

TEST(Check, TheOnlyValueOfATypeIsKnown) {
  const Model m = model_of(R"(domain one
types: object, place
constants: object o1; place p1
predicates: done(object)
functions: target(object) : place
action go(?o : object, ?l : place)
  preconds: K(target(?o) = ?l)
  effects: add(Kf, done(?o))
init: K(target(o1) = p1)
goal: K(done(o1))
)");
  EXPECT_TRUE(valid(m, good_plan(m)));
}

TEST(PlanFile, IsReadBackAsWritten) {
  const Model m = scenario("bartender", "2");
  const Plan plan = good_plan(m);
  EXPECT_TRUE(read_plan(m, write_plan(m, plan), "p.json") == plan);
}

TEST(PlanFile, RefusesForeignNames) {
  const Model m = scenario("stacked", "3");
  std::string text = write_plan(m, good_plan(m));
  const std::size_t at = text.find("\"move\"");
  text.replace(at, 6, "\"fly\"");
  EXPECT_THROW(read_plan(m, text, "p.json"), Error);
}

TEST(PlanFile, RefusesAnotherDomain) {
  const Model m = scenario("stacked", "3");
  std::string text = write_plan(m, good_plan(m));
  const std::string name = "\"" + m.name + "\"";
  text.replace(text.find(name), name.size(), "\"another\"");
  EXPECT_THROW(read_plan(m, text, "p.json"), Error);
}

/// The second one would say nothing, or something else: whoever made it meant another plan.
TEST(PlanFile, RefusesTwoCasesForAValue) {
  const Model m = scenario("force-sensing", "1");
  Plan plan = good_plan(m);
  const auto branching = std::ranges::find(plan.nodes, true, &Plan::Node::branches);
  ASSERT_NE(branching, plan.nodes.end());
  branching->branch.cases.push_back(branching->branch.cases[0]);
  EXPECT_THROW(check(m, plan), Error);
  EXPECT_THROW(read_plan(m, write_plan(m, plan), "p.json"), Error);
}

/// An effect of the world changes x by what r is; then x is sensed. Its value before is known to no
/// one any more, so that tells nothing of r.
TEST(Check, WhatIsSensedIsNotComparedWithWhatWasForgotten) {
  const Model m = load(
      {"t.pddl",
       "(define (domain d) (:requirements :contingent :conditional-effects) (:predicates (r) (x) "
       "(g))\n"
       " (:action peek :parameters () :observe (x))\n"
       " (:action look :parameters () :effect (when (not (r)) (not (x))) :observe (x))\n"
       " (:action right :parameters () :precondition (r) :effect (g))\n"
       " (:action wrong :parameters () :precondition (not (r)) :effect (g)))\n"
       "(define (problem p) (:domain d) (:init (unknown (r)) (unknown (x))) (:goal (g)))",
       Language::Pddl},
      nullptr);
  EXPECT_EQ(solved(m, Algorithm::Greedy).outcome, Outcome::Unsolvable);
  const std::string plan =
      R"({"format":"kaboum-plan","version":1,"domain":"d","root":0,"nodes":[
      {"action":"peek","arguments":[],"branch":{"predicate":"x","arguments":[],
       "cases":[{"value":true,"next":1},{"value":false,"next":1}]}},
      {"action":"look","arguments":[],"next":2},
      {"branch":{"predicate":"r","arguments":[],
       "cases":[{"value":true,"next":3},{"value":false,"next":4}]}},
      {"action":"right","arguments":[],"next":"goal"},
      {"action":"wrong","arguments":[],"next":"goal"}]})";
  const CheckResult r = check(m, read_plan(m, plan, "plan.json"));
  EXPECT_FALSE(r.valid);
  EXPECT_NE(r.violation.find("branches on r"), std::string::npos) << r.violation;
}

/// Propagation does not see the contradiction before one of the atoms is sensed.
TEST(Check, ContradictoryKnowledgeConfirmsNothing) {
  const Model m = model_of(
      "predicates: a, b, c, g\nclosed: g\ninit: Kx(a | b) Kx(b | c) Kx(a | c)\n"
      "action sense preconds: true effects: add(Kw, a)\n"
      "action read preconds: Kw(b) & Kw(c) effects: add(Kf, !g)\ngoal: K(g)");
  const Plan plan = read_plan(m,
                              R"({"format":"kaboum-plan","version":1,"domain":"","root":0,"nodes":[
      {"action":"sense","arguments":[],"next":1},{"action":"read","arguments":[],"next":"goal"}]})",
                              "plan.json");
  EXPECT_FALSE(works_merged(m, plan));
  EXPECT_FALSE(valid(m, plan));
}

/// Where more knowledge might harm, or less might do more, runs are not merged.
TEST(Check, MergesOnlyWhereMoreKnowledgeNeverHarms) {
  const auto takes = [](const std::string& action, const std::string& goal = "K(p)") {
    return MergedReplay::takes(
        model_of("types: t\nconstants: t a, b\npredicates: p, q\nfunctions: f : t, h : t\n"
                 "action x " +
                 action + "\ngoal: " + goal));
  };
  EXPECT_TRUE(takes("preconds: K(p) effects: add(Kf, q)"));
  EXPECT_TRUE(takes("preconds: K(!p) | Kw(q) effects: add(Kw, q), del(Kf, p)"));
  EXPECT_TRUE(takes("preconds: true effects: whenever K(p) => add(Kf, q)"));
  EXPECT_FALSE(takes("preconds: !K(p) effects: add(Kf, q)"));
  EXPECT_FALSE(takes("preconds: !Kw(p) effects: add(Kw, p)"));
  EXPECT_FALSE(takes("preconds: true effects: K(p) => add(Kf, q)"));
  EXPECT_FALSE(takes("preconds: true effects: add(Kx, p | q)"));
  EXPECT_FALSE(takes("preconds: true effects: add(Kf, f != a)"));
  EXPECT_FALSE(takes("preconds: K(p) effects: add(Kf, q)", "!K(p)"));
}

}  // namespace
}  // namespace kaboum::plan::test
