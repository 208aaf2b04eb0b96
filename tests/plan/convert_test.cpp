// Conversions: what is written is read back and has the same plans.
#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

std::string data(const std::string& file) {
  return slurp(std::string(KABOUM_DOMAINS) + "/../../tests/plan/data/" + file);
}

std::string plan_of(const std::string& text, Language language) {
  const Model m = load({"t", text, language}, nullptr);
  return plan_text(m, solved(m, Algorithm::BreadthFirst).plan);
}

TEST(Convert, KplIsAFixedPoint) {
  for (const char* name : {"stacked", "force-sensing", "bartender", "circular-rearrange",
                           "bimanual-assembly", "remove"}) {
    const Text d{"d.kpl", slurp(std::string(KABOUM_DOMAINS) + "/" + name + "/domain.kpl"),
                 Language::Kpl};
    const Text p{"p.kpl", made(name, "2"), Language::Kpl};
    const std::string once = convert(d, &p, Language::Kpl);
    EXPECT_EQ(convert({"o.kpl", once, Language::Kpl}, nullptr, Language::Kpl), once);
    EXPECT_EQ(plan_of(once, Language::Kpl), plan_of(d.text + p.text, Language::Kpl)) << name;
  }
}

TEST(Convert, PddlIsReadAndWritten) {
  const std::string pddl = data("blocks.pddl");
  const std::string plan = plan_of(pddl, Language::Pddl);
  const std::string kpl = convert({"d.pddl", pddl, Language::Pddl}, nullptr, Language::Kpl);
  EXPECT_EQ(plan_of(kpl, Language::Kpl), plan);
  const std::string again = convert({"d.kpl", kpl, Language::Kpl}, nullptr, Language::Pddl);
  EXPECT_EQ(plan_of(again, Language::Pddl), plan);
}

TEST(Convert, ConnectivesOfOneConditionOrNone) {
  for (const char* condition :
       {"(and (p))", "(or (p))", "(and (or (p)) (p))", "(and (and (p)))", "(and (p) (and))",
        "(or (p) (or))", "(and (forall (?x - object) (and (r ?x))) (p))",
        "(and (or (and (p) (p))) (p))", "(imply (and (p)) (and (p)))"}) {
    const std::string pddl =
        std::string(
            "(define (domain d) (:requirements :adl) (:predicates (p) (q) (r ?x)) "
            "(:action a :parameters () :precondition ") +
        condition +
        " :effect (and (q))))"
        "(define (problem x) (:domain d) (:objects o) (:init (p) (r o)) (:goal (and (q))))";
    std::string kpl;
    ASSERT_NO_THROW(kpl = convert({"d.pddl", pddl, Language::Pddl}, nullptr, Language::Kpl))
        << condition;
    EXPECT_EQ(plan_of(kpl, Language::Kpl), plan_of(pddl, Language::Pddl)) << kpl;
  }
}

TEST(Convert, AQuantifiedConditionIsNoQuantifiedEffect) {
  // Not all have r: nothing happens. "forallK(?x) K(r(?x)) => ..." would act for the one that has.
  const std::string pddl =
      "(define (domain d) (:requirements :adl) (:predicates (p) (q) (r ?x)) (:action a :parameters "
      "() :effect (and (p) (when (and (forall (?x - object) (r ?x)) (and)) (q)))))"
      "(define (problem x) (:domain d) (:objects o u) (:init (r o)) (:goal (q)))";
  std::string kpl;
  ASSERT_NO_THROW(kpl = convert({"d.pddl", pddl, Language::Pddl}, nullptr, Language::Kpl));
  for (const Algorithm a : kAll)
    EXPECT_EQ(solve(load({"d.kpl", kpl, Language::Kpl}, nullptr),
                    [&] {
                      SolveOptions o;
                      o.algorithm = a;
                      return o;
                    }())
                  .outcome,
              Outcome::Unsolvable);
}

TEST(Convert, EffectsThatPddlReadsOtherwise) {
  const auto to_pddl = [](const std::string& effects) {
    const std::string kpl =
        "types: v\nconstants: v a, b\npredicates: p(v), q(v), done\nfunctions: f : v\n"
        "init: K(f = a), K(q(a))\nclosed: all\naction s preconds: true effects: " +
        effects + "\naction t preconds: K(p(b)) & K(f = b) effects: add(Kf, done)\ngoal: K(done)";
    return convert({"t.kpl", kpl, Language::Kpl}, nullptr, Language::Pddl);
  };
  // The value may stand on the left.
  EXPECT_NE(to_pddl("add(Kf, b = f), add(Kf, p(b))").find("(assign (f) b)"), std::string::npos);
  EXPECT_THROW(to_pddl("add(Kf, f != a)"), Error);
  EXPECT_THROW(to_pddl("add(Kf, !f = a)"), Error);
  // For b, p(b) is deleted after it was added for a; PDDL would keep it.
  EXPECT_THROW(to_pddl("forall(?o : v) { add(Kf, !p(?o)), K(q(?o)) => add(Kf, p(b)) }"), Error);
  EXPECT_NO_THROW(
      to_pddl("forall(?o : v) add(Kf, !p(?o)), forall(?o : v) { K(q(?o)) => add(Kf, p(b)) }"));
}

TEST(Convert, ConditionsThatMayBeUnknownAreNoPddl) {
  // Here nothing happens unless p is known; in PDDL q might be lost, and there would be no plan.
  const auto kpl = [](const char* unknown) {
    return Text{"t.kpl",
                std::string("predicates: p, q, r\ninit: K(q)\nclosed: all\n") + unknown +
                    "action s preconds: true effects: K(p) => add(Kf, !q), add(Kf, r)\n"
                    "goal: K(q) & K(r)",
                Language::Kpl};
  };
  EXPECT_THROW(convert(kpl("unknown: p\n"), nullptr, Language::Pddl), Error);
  EXPECT_NO_THROW(convert(kpl(""), nullptr, Language::Pddl));
}

TEST(Convert, NamesThatTheTargetCannotSay) {
  const std::string pddl =
      "(define (domain d) (:predicates (p ?x) (NAME)) (:action a :parameters (?x) :effect (p ?x)))"
      "(define (problem q) (:domain d) (:objects OBJECT) (:goal (p OBJECT)))";
  const auto with = [&](const std::string& name, const std::string& object) {
    std::string t = pddl;
    t.replace(t.find("NAME"), 4, name);
    for (std::size_t at = 0; (at = t.find("OBJECT")) != std::string::npos;)
      t.replace(at, 6, object);
    return convert({"t.pddl", t, Language::Pddl}, nullptr, Language::Kpl);
  };
  EXPECT_NE(with("q", "b-1").find("b-1"), std::string::npos);
  for (const auto& [name, object] : {std::pair("q", "1b"), std::pair("q", "b.1"),
                                     std::pair("extern", "b"), std::pair("kf@", "b")})
    EXPECT_THROW(with(name, object), Error) << name << " " << object;
  const auto to_pddl = [](const std::string& kpl) {
    return convert({"t.kpl", kpl, Language::Kpl}, nullptr, Language::Pddl);
  };
  EXPECT_THROW(to_pddl("predicates: isOn, ison\nclosed: all\ngoal: K(isOn)"), Error);
  EXPECT_THROW(
      to_pddl("types: v\nconstants: v a\npredicates: p(v)\nclosed: all\naction x(?a : v, ?b : v) "
              "preconds: true effects: add(Kf, p(?a)), add(Kf, !p(?b))\ngoal: K(p(a))"),
      Error);
}

TEST(Convert, ObjectMayBeOneTypeAmongOthers) {
  // In PDDL "object" is the root: robots would become objects.
  const std::string kpl =
      "types: object, robot\nconstants: object o; robot r; free\npredicates: p(object), s\n"
      "closed: all\naction a(?o : object) preconds: K(!p(?o)) effects: add(Kf, p(?o))\n"
      "goal: forallK(?x : object) K(p(?x))";
  const std::string plan = plan_of(kpl, Language::Kpl);
  const std::string pddl = convert({"t.kpl", kpl, Language::Kpl}, nullptr, Language::Pddl);
  EXPECT_EQ(plan_of(pddl, Language::Pddl), plan) << pddl;
  const std::string again = convert({"t.kpl", kpl, Language::Kpl}, nullptr, Language::Kpl);
  EXPECT_EQ(plan_of(again, Language::Kpl), plan) << again;
}

TEST(Convert, NamesWhatCannotBeSaid) {
  const Text d{"d.kpl",
               slurp(std::string(KABOUM_DOMAINS) + "/remove/domain.kpl") + made("remove", "2"),
               Language::Kpl};
  EXPECT_THROW(convert(d, nullptr, Language::Pddl), Error);
}

TEST(Show, TextOfAChainOfVeryManyBranchesIsALimit) {
  const Model m = model_of("predicates: p\ninit: Kw(p)\ngoal: true");
  Plan plan;
  constexpr Index kNodes = 30'000;
  plan.nodes.resize(kNodes);
  for (Index i = 0; i < kNodes; ++i) {
    plan.nodes[i].branches = true;
    plan.nodes[i].branch = {false, 0, {}, {{1, i + 1 == kNodes ? kNone : i + 1}, {0, kNone}}};
  }
  plan.root = 0;
  EXPECT_THROW(plan_text(m, plan), Error);
  EXPECT_LT(plan_dot(m, plan).size(), 10'000'000U);
}

TEST(Show, TextDotAndSvgNameEveryAction) {
  const Model m = scenario("force-sensing", "2");
  const Plan plan = solved(m, Algorithm::BreadthFirst).plan;
  for (const std::string& text : {plan_text(m, plan), plan_dot(m, plan), plan_svg(m, plan)})
    for (const Plan::Node& n : plan.nodes)
      EXPECT_NE(text.find(action_text(m, n.action)), std::string::npos);
}

}  // namespace
}  // namespace kaboum::plan::test
