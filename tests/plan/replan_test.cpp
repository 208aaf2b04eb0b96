// Plans under assumptions, and execution that plans again where one fails: for every way that
// sensing may turn out, what is done has to be what each thing asks for.

#include <kaboum/plan/replan.h>

#include <algorithm>
#include <functional>

#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

/// Things that are weighed, then carried by one arm or, if heavy, by the strong one. Where the
/// robot goes is a handle, whose words have blanks, and the next call is about it.
std::string weighing(int n, bool strong = true) {
  std::string text = "types: object, conf handle\nconstants: conf home; object ";
  for (int i = 1; i <= n; ++i) text += (i > 1 ? ", o" : "o") + std::to_string(i);
  text +=
      "\npredicates: isHeavy(object), isDone(object), isFree\nfunctions: at : conf\n"
      "externals: go(object, conf) : conf\n"
      "action weigh(?o : object) preconds: K(isFree) & !Kw(isHeavy(?o))"
      " effects: add(Kf, !isFree), add(Kw, isHeavy(?o))\n";
  for (const std::string name : {"carry", "haul"})
    if (name == "carry" || strong)
      text += "action " + name + "(?o : object) preconds: K(" + (name == "carry" ? "!" : "") +
              "isHeavy(?o)) & K(!isDone(?o)) & let ?q = extern(go(?o, at))"
              " effects: add(Kf, isFree), add(Kf, isDone(?o)), add(Kf, at = ?q)\n";
  text += "init: K(at = home), K(isFree)";
  for (int i = 1; i <= n; ++i) text += ", K(!isDone(o" + std::to_string(i) + "))";
  return text + "\ngoal: forallK(?o : object) K(isDone(?o))";
}

ExternalBindings walk() {
  ExternalBindings all;
  all["go"] = [](const Question& q) {
    return Answer::found("q 0.5 " + std::to_string(q.arguments[1].size()) + " to " + q.arguments[0],
                         "from " + q.arguments[1]);
  };
  return all;
}

struct Case {
  TaskTexts texts;
  Model model;
  Plan plan;

  Case(const std::string& text, const std::map<std::string, std::string>& assumed)
      : texts{{"t.kpl", text, Language::Kpl}, std::nullopt, walk()},
        model(load(texts.domain, nullptr, texts.bindings)) {
    SolveOptions o;
    o.algorithm = Algorithm::Greedy;
    o.assumed = assumed;
    const Solution s = solve(model, o);
    EXPECT_EQ(s.outcome, Outcome::Solved);
    plan = s.plan;
  }

  /// What is done, action by action: "haul(o1) from home".
  ReplanSummary carry_out(const ReplanOptions& options, std::vector<std::string>& done) const {
    return run_and_replan(texts, model, plan, options, [&](const Model& m, const Plan& p) {
      return [&](const RunStep& step) {
        const Plan::Node& node = p.nodes[step.node];
        if (!node.acts) return;
        done.push_back(action_text(m, node.action));
        // Each plan's words go on from where the one before ended.
        for (const Plan::Call& call : node.calls) {
          EXPECT_EQ(call.arguments.at(1), step.before.value("at", {}));
          EXPECT_EQ(call.value, step.after.value("at", {}));
          EXPECT_EQ(call.payload, "from " + call.arguments.at(1));
        }
      };
    });
  }
};

std::map<std::string, std::string> all_light(int n) {
  std::map<std::string, std::string> out;
  for (int i = 1; i <= n; ++i) out["isHeavy(o" + std::to_string(i) + ")"] = "false";
  return out;
}

TEST(Replan, APlanUnderAssumptionsHasNoOtherBranches) {
  const Case c(weighing(4), all_light(4));
  const PlanSize size = measure(c.model, c.plan);
  EXPECT_EQ(size.leaves, 1U);
  EXPECT_EQ(size.longest, 8U);
  EXPECT_FALSE(check(c.model, c.plan).valid) << "it is no plan for all that may happen";
  const Case full(weighing(4), {});
  EXPECT_EQ(measure(full.model, full.plan).leaves, 16U);
  // All searches know assumptions.
  for (const Algorithm a : kAll) {
    SolveOptions o;
    o.algorithm = a;
    o.assumed = {{"isHeavy(o2)", "true"}};
    const Solution s = solve(c.model, o);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    EXPECT_EQ(measure(c.model, s.plan).leaves, 8U);
  }
}

TEST(Replan, EveryOutcomeEndsWithWhatItAsksFor) {
  constexpr int kThings = 4;
  const Case c(weighing(kThings), all_light(kThings));
  for (unsigned heavy = 0; heavy < (1U << kThings); ++heavy) {
    ReplanOptions options;
    options.run.outcomes = RunOptions::Outcomes::Given;
    unsigned count = 0;
    for (int i = 0; i < kThings; ++i) {
      const bool is = (heavy >> static_cast<unsigned>(i) & 1U) != 0;
      count += is ? 1 : 0;
      options.run.given["isHeavy(o" + std::to_string(i + 1) + ")"] = is ? "true" : "false";
    }
    // Planned again with the assumptions: each heavy thing is a surprise of its own.
    options.solve.assumed = all_light(kThings);
    for (const bool again : {true, false}) {
      if (!again) options.solve.assumed.clear();
      std::vector<std::string> done;
      const ReplanSummary s = c.carry_out(options, done);
      EXPECT_TRUE(s.complete());
      EXPECT_EQ(s.replans.size(), again ? count : std::min(count, 1U));
      for (int i = 0; i < kThings; ++i) {
        const bool is = (heavy >> static_cast<unsigned>(i) & 1U) != 0;
        const std::string o = "(o" + std::to_string(i + 1) + ")";
        EXPECT_EQ(std::ranges::count(done, "weigh" + o), 1);
        EXPECT_EQ(std::ranges::count(done, "haul" + o), is ? 1 : 0);
        EXPECT_EQ(std::ranges::count(done, "carry" + o), is ? 0 : 1);
        EXPECT_LT(std::ranges::find(done, "weigh" + o),
                  std::ranges::find(done, (is ? "haul" : "carry") + o));
      }
      EXPECT_EQ(done.size(), 2U * kThings);
    }
  }
}

TEST(Replan, AllOutcomesAtOnce) {
  const Case c(weighing(3), all_light(3));
  ReplanOptions options;
  std::vector<std::string> done;
  const ReplanSummary s = c.carry_out(options, done);
  EXPECT_TRUE(s.complete());
  EXPECT_EQ(s.replans.size(), 3U);  // from each of three places on the way
  for (const Replan& r : s.replans) {
    EXPECT_EQ(r.after, 0U);
    EXPECT_EQ(r.outcome.substr(0, 9), "isHeavy(o") << r.outcome;
    EXPECT_GT(r.nodes, 0U);
  }
  std::vector<std::string> again;
  EXPECT_EQ(c.carry_out(options, again).run.branches, s.run.branches);
  EXPECT_EQ(done, again);
}

TEST(Replan, WhatCannotBePlannedIsSaid) {
  const Case c(weighing(2, false), all_light(2));
  ReplanOptions options;
  options.run.outcomes = RunOptions::Outcomes::Given;
  options.run.given = {{"isHeavy(o1)", "false"}, {"isHeavy(o2)", "true"}};
  std::vector<std::string> done;
  ReplanSummary s = c.carry_out(options, done);
  ASSERT_EQ(s.replans.size(), 1U);
  EXPECT_FALSE(s.complete());
  EXPECT_EQ(s.replans[0].outcome, "isHeavy(o2)");
  EXPECT_EQ(s.replans[0].result, Outcome::Unsolvable);
  EXPECT_EQ(s.replans[0].reason, "every possibility was tried");
  // The limit.
  const Case more(weighing(3), all_light(3));
  options.run.outcomes = RunOptions::Outcomes::All;
  options.run.given.clear();
  options.solve.assumed = all_light(3);
  options.most = 2;
  s = more.carry_out(options, done);
  EXPECT_FALSE(s.complete());
  EXPECT_EQ(s.replans.back().result, Outcome::Limit);
  EXPECT_EQ(s.replans.back().reason, "more than 2 new plans are needed");
  // Without replanning it is an error, as ever.
  EXPECT_THROW(run(more.model, more.plan, {}, [](const RunStep&) {}), Error);
}

TEST(Replan, KnowledgeOfEveryKindIsTakenOver) {
  // A value that is ruled out, and a disjunction that is open, both needed after the surprise.
  const std::string text =
      "types: v\nconstants: v a, b, c\npredicates: p, q, r, s, done\nfunctions: f : v\n"
      "init: Kx(p | q | r), K(f != a), K(!done)\n"
      "action look preconds: !Kw(s) effects: add(Kw, s)\n"
      "action lookP preconds: K(s) & !Kw(p) effects: add(Kw, p)\n"
      "action lookQ preconds: K(s) & !Kw(q) effects: add(Kw, q)\n"
      "action lookF preconds: K(s) & !Kv(f) effects: add(Kv, f)\n"
      "action easy preconds: K(!s) effects: add(Kf, done)\n"
      "action hardB preconds: K(f = b) & (K(p) | K(q) | K(r)) effects: add(Kf, done)\n"
      "action hardC preconds: K(f = c) & (K(p) | K(q) | K(r)) effects: add(Kf, done)\n"
      "goal: K(done)";
  const Case c(text, {{"s", "false"}});
  EXPECT_EQ(measure(c.model, c.plan).longest, 2U);
  std::vector<std::string> done;
  ReplanOptions options;
  const ReplanSummary s = c.carry_out(options, done);
  ASSERT_EQ(s.replans.size(), 1U);
  EXPECT_TRUE(s.complete()) << s.replans[0].reason;
  EXPECT_EQ(s.replans[0].outcome, "s");
}

TEST(Replan, WhatIsKnownIsSaidInSentences) {
  const Case c(
      "types: v\nconstants: v a, b, c\npredicates: p(v), q, r, s, done\nfunctions: f(v) : v, g : "
      "v\n"
      "init: Kx(p(a) | q), Or(!q | r), K(f(b) != a), K(g = c), K(!done)\n"
      "action look preconds: !Kw(s) effects: add(Kw, s)\n"
      "action easy preconds: K(!s) effects: add(Kf, done)\n"
      "action hard preconds: K(s) effects: add(Kf, done)\n"
      "goal: K(done)",
      {});
  using Sentences = std::set<std::string>;
  const Sentences first{"!done", "f(b) != a", "g = c", "one of p(a), q", "!q or r"};
  int looked = 0;
  run(c.model, c.plan, {}, [&](const RunStep& step) {
    if (action_text(c.model, c.plan.nodes[step.node].action) != "look") return;
    EXPECT_EQ(sentences_of(step.before.facts()), first);
    Sentences then = first;
    then.insert(step.outcome);
    ++looked;
    EXPECT_EQ(sentences_of(step.after.facts()), then);
  });
  EXPECT_EQ(looked, 2);
}

TEST(Replan, WhyItIsPlannedAgainIsToldBeforeAndAfter) {
  const Case c(weighing(2), all_light(2));
  ReplanOptions options;
  options.run.outcomes = RunOptions::Outcomes::Given;
  options.run.given = {{"isHeavy(o1)", "true"}, {"isHeavy(o2)", "true"}};
  options.solve.assumed = all_light(2);
  std::vector<std::string> told;
  options.planning = [&](const Unplanned& why, unsigned after) {
    const std::set<std::string> known = sentences_of(why.known);
    EXPECT_TRUE(known.contains(why.outcome)) << why.outcome;
    told.push_back(std::to_string(after) + " lacks " + why.outcome);
  };
  options.planned = [&](const Replan& made) {
    EXPECT_EQ(made.result, Outcome::Solved);
    told.push_back("plan " + std::to_string(made.plan) + " for " + made.outcome);
  };
  std::vector<std::string> done;
  const ReplanSummary s = c.carry_out(options, done);
  ASSERT_EQ(s.replans.size(), 2U);
  const std::string first = s.replans[0].outcome, second = s.replans[1].outcome;
  EXPECT_EQ(told, (std::vector<std::string>{"0 lacks " + first, "plan 1 for " + first,
                                            "1 lacks " + second, "plan 2 for " + second}));
}

/// Looks, and is done if s does not hold; else by p, q or r, after looking at p or q.
std::string by_one_of(const std::string& initial, const std::string& actions = "") {
  return "predicates: p, q, r, s, ready, done\n"
         "action look preconds: !Kw(s) & K(ready) effects: add(Kw, s)\n"
         "action lookP preconds: K(s) & !Kw(p) effects: add(Kw, p)\n"
         "action lookQ preconds: K(s) & !Kw(q) effects: add(Kw, q)\n"
         "action easy preconds: K(!s) effects: add(Kf, done)\n"
         "action byP preconds: K(s) & K(p) & K(!ready) effects: add(Kf, done)\n"
         "action byQ preconds: K(s) & K(q) effects: add(Kf, done)\n"
         "action byR preconds: K(s) & K(r) effects: add(Kf, done)\n"
         "action unready preconds: K(s) effects: add(Kf, !ready)\n" +
         actions + "init: " + initial + ", K(!done)\ngoal: K(done)";
}

/// All that happens, with the replans of the first surprise.
ReplanSummary surprised(const Case& c, std::vector<std::string>& done) {
  const ReplanSummary s = c.carry_out({}, done);
  EXPECT_EQ(s.replans.size(), 1U);
  return s;
}

TEST(Replan, DisjunctionsThatStillHoldAreTakenOver) {
  for (const char* initial : {"Or(p | q), K(ready)", "Or(q | !r), Or(p | r), K(ready)"}) {
    const std::string text = by_one_of(initial);
    EXPECT_EQ(solve(model_of(text), {}).outcome, Outcome::Solved);
    const Case c(text, {{"s", "false"}});
    int plans = 0;
    const ReplanSummary s =
        run_and_replan(c.texts, c.model, c.plan, {}, [&](const Model& m, const Plan& p) {
          // The second is a plan for all that may be, on what was taken over alone.
          if (++plans == 2) {
            EXPECT_TRUE(check(m, p).valid) << check(m, p).violation;
          }
          return [](const RunStep&) {};
        });
    EXPECT_EQ(plans, 2);
    EXPECT_TRUE(s.complete()) << initial << ": " << s.replans.at(0).reason;
  }
  const Case c(by_one_of("Or(p | !q | r), K(r), Or(p | !q), K(ready)"), {{"s", "false"}});
  RunOptions options;
  options.unplanned = [](const Unplanned& what) {
    ASSERT_EQ(what.known.some.size(), 1U) << "the other says nothing more";
    EXPECT_EQ(what.known.some[0],
              (std::set<std::pair<KnownFacts::Term, bool>>{{{"p"}, true}, {{"q"}, false}}));
    EXPECT_FALSE(what.known.cut);
  };
  run(c.model, c.plan, options, [](const RunStep&) {});
}

TEST(Replan, WhatIsCutDownIsNeverUnsolvable) {
  // q or r holds, as p did not or did; but p may be another when anything is seen.
  const std::string set = "action set preconds: !K(ready) effects: add(Kf, ready), del(Kf, p)\n";
  const std::string text = by_one_of("Or(p | q), Or(!p | r), K(!ready)", set);
  EXPECT_EQ(solve(model_of(text), {}).outcome, Outcome::Solved);
  std::vector<std::string> done;
  ReplanSummary s = surprised({text, {{"s", "false"}}}, done);
  EXPECT_FALSE(s.complete());
  EXPECT_EQ(s.replans.at(0).result, Outcome::NotInferred);
  EXPECT_NE(s.replans.at(0).reason.find("more is known"), std::string::npos)
      << s.replans.at(0).reason;
  // Of a single disjunction nothing is lost: then it is a proof.
  s = surprised({by_one_of("Or(q | p), K(!r), K(!ready)", set), {{"s", "false"}}}, done);
  EXPECT_EQ(s.replans.at(0).result, Outcome::Unsolvable);
}

TEST(Replan, WhatMayHaveChangedInTheWorldIsNotTakenForKnown) {
  // Where p holds, q does not after setting; that q held before says nothing.
  const std::string text = by_one_of(
      "K(q), K(r), K(!ready)",
      "action set preconds: !K(ready) effects: add(Kf, ready), whenever K(p) => { add(Kf, !q) }\n");
  std::vector<std::string> done;
  ReplanSummary s = surprised({text, {{"s", "false"}}}, done);
  EXPECT_TRUE(s.complete());
  const std::string without =
      text.substr(0, text.find("action byR")) + text.substr(text.find("action unready"));
  s = surprised({without, {{"s", "false"}}}, done);
  EXPECT_EQ(s.replans.at(0).result, Outcome::NotInferred);
}

TEST(Replan, WordsThatAreNamesOfTwoTypesAreRefused) {
  const auto says = [](const char* word) {
    const std::string text =
        "types: object, conf handle, pose handle\nconstants: object o1; conf home\n"
        "predicates: s, done\nfunctions: at : conf; on : pose\n"
        "externals: go(conf) : conf; put(conf) : pose\n"
        "action move preconds: K(at = home) & let ?q = extern(go(at)) & let ?p = extern(put(at))"
        " effects: add(Kf, at = ?q), add(Kf, on = ?p)\n"
        "action look preconds: !Kw(s) effects: add(Kw, s)\n"
        "action use preconds: Kw(s) effects: add(Kf, done)\n"
        "init: K(at = home)\ngoal: K(done) & (K(s) | K(!s))";
    KnownFacts known;
    known.values[{"at"}] = word;
    known.values[{"on"}] = "w";
    ExternalBindings all;
    all["go"] = all["put"] = [](std::span<const std::string>) { return std::string("w"); };
    try {
      load_from(known, {"t.kpl", text, Language::Kpl}, nullptr, all);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(says("v"), "no error");
  EXPECT_EQ(says("home"), "no error");
  for (const char* word : {"o1", "w"})
    EXPECT_NE(says(word).find("which is a name of two types here"), std::string::npos)
        << says(word);
}

TEST(Replan, WhoComesBackToWhereItWasPlannedIsNotDone) {
  const std::string text =
      "predicates: p, done\n"
      "action look preconds: !Kw(p) effects: add(Kw, p)\n"
      "action shake preconds: K(!p) effects: del(Kf, !p)\n"
      "action use preconds: K(p) effects: add(Kf, done)\n"
      "init: K(!done)\ngoal: K(done)";
  const Case c(text, {{"p", "true"}});
  ReplanOptions options;
  options.solve.assumed = {{"p", "true"}};
  for (const bool all : {true, false}) {
    if (!all) {
      options.run.outcomes = RunOptions::Outcomes::Given;
      options.run.given = {{"p", "false"}};
    }
    std::vector<std::string> done;
    const ReplanSummary s = c.carry_out(options, done);
    EXPECT_EQ(std::ranges::count(done, "use"), all ? 2 : 0);
    ASSERT_EQ(s.replans.size(), 2U);
    EXPECT_FALSE(s.replans[0].circle);
    EXPECT_EQ(s.replans[1].after, 1U);
    EXPECT_TRUE(s.replans[1].reached);
    EXPECT_TRUE(s.replans[1].circle);
    EXPECT_EQ(s.replans[1].reason, "the plan for this leads back to it");
    EXPECT_FALSE(s.complete());
  }
}

/// f is sensed, after a has been ruled out where t holds.
std::string ruled_out(const std::string& initial, bool use_c) {
  return std::string(
             "types: v\nconstants: v a, b, c\npredicates: t, stripped, done\nfunctions: f : v\n"
             "action lookT preconds: !Kw(t) effects: add(Kw, t)\n"
             "action strip preconds: K(t) & !K(stripped) effects: add(Kf, f != a), "
             "add(Kf, stripped)\n"
             "action senseN preconds: K(!t) & !Kv(f) effects: add(Kv, f)\n"
             "action senseS preconds: K(stripped) & !Kv(f) effects: add(Kv, f)\n"
             "action useA preconds: K(f = a) effects: add(Kf, done)\n"
             "action useB preconds: K(f = b) effects: add(Kf, done)\n") +
         (use_c ? "action useC preconds: K(f = c) effects: add(Kf, done)\n" : "") +
         "init: " + initial + "K(!done), K(!stripped)\ngoal: K(done)";
}

TEST(Assumptions, BranchesHaveThemOnlyWhereTheyArePossible) {
  for (const Algorithm a : kAll) {
    SolveOptions o;
    o.algorithm = a;
    o.assumed = {{"f", "a"}};
    EXPECT_EQ(solve(model_of(ruled_out("", false)), o).outcome, Outcome::Unsolvable);
    EXPECT_EQ(solve(model_of(ruled_out("K(t), ", false)), o).outcome, Outcome::Unsolvable);
    EXPECT_EQ(solve(model_of(ruled_out("K(!t), ", false)), o).outcome, Outcome::Solved);
    const Model m = model_of(ruled_out("", true));
    const Solution s = solve(m, o);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    int without = 0;
    RunOptions run_options;
    run_options.unplanned = [&](const Unplanned& what) {
      ++without;
      EXPECT_FALSE(what.known.atoms.at({"stripped"})) << what.outcome;
    };
    run(m, s.plan, run_options, [](const RunStep&) {});
    EXPECT_EQ(without, 2) << plan_text(m, s.plan);
  }
}

/// An atom that is known to be otherwise in one branch, where the same steps would follow.
TEST(Assumptions, AtomsThatAreKnownToBeOtherwiseAreNotAssumed) {
  const std::string text =
      "predicates: t, p, wet, done\n"
      "action lookT preconds: !Kw(t) effects: add(Kw, t)\n"
      "action soak preconds: K(t) & !K(wet) effects: add(Kf, wet), add(Kf, !p)\n"
      "action dry preconds: K(!t) & !K(wet) effects: add(Kf, wet)\n"
      "action lookP preconds: K(wet) & !Kw(p) effects: add(Kw, p)\n"
      "action use preconds: K(wet) & K(p) effects: add(Kf, done)\n";
  for (const Algorithm a : kAll) {
    SolveOptions o;
    o.algorithm = a;
    o.assumed = {{"p", "true"}};
    EXPECT_EQ(solve(model_of(text + "init: K(!done), K(!wet)\ngoal: K(done)"), o).outcome,
              Outcome::Unsolvable);
    EXPECT_EQ(solve(model_of(text + "init: K(!t), K(!done), K(!wet)\ngoal: K(done)"), o).outcome,
              Outcome::Solved);
  }
}

TEST(Assumptions, OfWhatThereIsNotAreRefused) {
  const Case c(weighing(2), {});
  const auto says = [&](const std::string& text, const char* value) {
    SolveOptions o;
    o.assumed = {{text, value}};
    try {
      solve(c.model, o);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(says("isBlue(o1)", "true"),
            "it is assumed of 'isBlue(o1)', which the model does not have");
  EXPECT_EQ(says("isHeavy(o9)", "true"), "it is assumed of 'isHeavy(o9)', but there is no 'o9'");
  EXPECT_EQ(says("isHeavy", "true"), "it is assumed of 'isHeavy', which has other arguments");
  EXPECT_EQ(says("isHeavy(o1)", "maybe"),
            "it is assumed of 'isHeavy(o1)', which is true or false, not maybe");
  for (const char* text : {"isHeavy(o1", "isHeavy o1)", "isHeavy(o1))", "isHeavy(o1) x", "", "(o1)",
                           "isHeavy(o1,)", "isHeavy(,o1)", "isHeavy(o1()"})
    EXPECT_EQ(says(text, "true").find("it is assumed of '" + std::string(text) + "', which is no"),
              0U)
        << says(text, "true");
  EXPECT_EQ(says("isHeavy(o 1)", "true"), "it is assumed of 'isHeavy(o 1)', but there is no 'o 1'");
  EXPECT_EQ(says(" isHeavy( o1 ) ", "true"), "no error");
  EXPECT_EQ(says("isFree()", "true"), "no error");
}

TEST(Replan, OutcomesOfWhatThereIsNotAreRefused) {
  const Case c(weighing(2), {});
  const auto says = [&](const char* text, const char* value) {
    RunOptions o;
    o.outcomes = RunOptions::Outcomes::Given;
    o.given = {{text, value}};
    try {
      run(c.model, c.plan, o, [](const RunStep&) {});
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(says("isHeavy(o1)", "true"), "no error");
  EXPECT_EQ(says("isHeavy( o1 )", "false"), "no error");
  EXPECT_EQ(says("isHeavy(o1)", "yes"),
            "an outcome is given for 'isHeavy(o1)', which is true or false, not yes");
  EXPECT_EQ(says("isBlue(o1)", "true"),
            "an outcome is given for 'isBlue(o1)', which the model does not have");
  EXPECT_EQ(says("isHeavy(o1", "true"),
            "an outcome is given for 'isHeavy(o1', which is no atom or term");
  EXPECT_EQ(says("isHeavy(o1, o2)", "true"),
            "an outcome is given for 'isHeavy(o1, o2)', which has other arguments");
  EXPECT_EQ(says("isHeavy(o 1)", "true"),
            "an outcome is given for 'isHeavy(o 1)', but there is no 'o 1'");
}

}  // namespace
}  // namespace kaboum::plan::test
