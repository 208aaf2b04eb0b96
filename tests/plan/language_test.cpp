// The language: what is read, and what errors say.
#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

const std::string kHead =
    "predicates: p(object), q(object), r\n"
    "functions: f(object) : object\n"
    "constants: object a, b\n";

std::string with_action(const std::string& preconds, const std::string& effects) {
  return kHead + "action act(?x : object)\n  preconds: " + preconds + "\n  effects: " + effects +
         "\ngoal: K(r)\n";
}

TEST(Language, ErrorsHaveFileLineColumnAndCaret) {
  const std::string message =
      complaint("predicates: p(object)\nconstants: object a\ngoal: K(zz(a))\n");
  EXPECT_EQ(message, "bad.kpl:3:9: error: unknown predicate 'zz'\n  goal: K(zz(a))\n          ^");
}

TEST(Language, FindsMistakesAtLoad) {
  const std::pair<std::string, std::string> cases[] = {
      {with_action("K(p(?y))", "add(Kf, r)"), "unknown variable '?y'"},
      {with_action("K(p(?x, ?x))", "add(Kf, r)"), "takes 1 argument, not 2"},
      {with_action("K(p(c))", "add(Kf, r)"), "unknown constant 'c'"},
      {with_action("p(?x)", "add(Kf, r)"), "expected a query"},
      {with_action("p(?x)", "add(Kf, r)"), "write K(p(...)) for what is known"},
      {with_action("r", "add(Kf, r)"), "write K(r) for what is known"},
      {with_action("K(r) and K(r)", "add(Kf, r)"), "'&' means and"},
      {with_action("K(r)", "maybe(Kw, r)"), "its database is Kf"},
      {with_action("K(f(?x))", "add(Kf, r)"), "is a function: compare it"},
      {with_action("K(p(?x))", "add(Kq, r)"), "expected a database"},
      {with_action("K(p(?x))", "add(Kv, p(?x))"), "Kv holds a function term"},
      {with_action("K(p(?x))", "add(Kw, f(?x) = a)"), "Kw holds atoms"},
      {with_action("K(p(?x))", "add(Kx, p(a))"), "two or more alternatives"},
      {with_action("extern(g(?x))", "add(Kf, r)"), "unknown external function 'g'"},
      {with_action("K(p(?x)", "add(Kf, r)"), "expected ')'"},
      {kHead + "predicates: p(object)\ngoal: K(r)", "declared twice"},
      {kHead + "types: t : s\ngoal: K(r)", "unknown type 's'"},
      {kHead + "types: s : t, t : s\ngoal: K(r)", "its own ancestor"},
      {kHead + "externals: g(object)\ngoal: K(r)", "bound to nothing"},
      {kHead + "externals: g(object)\ntable g: (a, b)\ngoal: K(r)", "takes 1 argument, not 2"},
      {kHead + "init: K(p(?x))\ngoal: K(r)", "unknown variable"},
      {kHead, "no goal: give the problem's file"},
      {"goal: K(\x01)", "unexpected character"},
  };
  for (const auto& [text, expected] : cases)
    EXPECT_NE(complaint(text).find(expected), std::string::npos)
        << text << "\n--> " << complaint(text);
}

TEST(Language, ChecksTypes) {
  const std::string head =
      "types: box, robot\npredicates: full(box)\nfunctions: inside(box) : box\nconstants: box b; "
      "robot r\n";
  EXPECT_NE(complaint(head + "goal: K(full(r))").find("'r' is of type robot, expected box"),
            std::string::npos);
  EXPECT_NE(complaint(head + "goal: K(inside(b) = r)").find("expected box"), std::string::npos);
  EXPECT_NE(complaint(head + "goal: forallK(?x : robot) K(full(?x))").find("'x' is of type robot"),
            std::string::npos);
}

TEST(Language, RefusesContradictoryInitialKnowledge) {
  const Model m = model_of(
      kHead +
      "init: K(p(a)) K(!p(a))\naction x preconds: true effects: add(Kf, !p(a))\ngoal: K(r)");
  EXPECT_THROW(solve(m, {}), Error);
}

/// One state: does the goal hold at once?
bool holds(const std::string& init, const std::string& goal) {
  const Model m = model_of(kHead + "init: " + init + "\ngoal: " + goal + "\n");
  const Solution s = solve(m, {});
  const bool now = s.outcome == Outcome::Solved && s.plan.root == kNone;
  Plan empty;
  EXPECT_EQ(check(m, empty).valid, now) << init << " / " << goal;
  return now;
}

TEST(Language, Queries) {
  EXPECT_TRUE(holds("K(p(a))", "K(p(a)) & !K(p(b)) & !K(!p(b)) & Kw(p(a)) & !Kw(p(b))"));
  EXPECT_TRUE(holds("K(!p(a))", "K(!p(a)) & Kw(p(a)) & !K(p(a))"));
  EXPECT_TRUE(
      holds("K(f(a) = b)", "K(f(a) = b) & K(b = f(a)) & K(f(a) != a) & Kv(f(a)) & !Kv(f(b))"));
  EXPECT_TRUE(holds("K(f(a) = b) K(p(b))", "K(p(f(a)))"));
  EXPECT_FALSE(holds("K(p(b))", "K(p(f(a)))"));
  EXPECT_TRUE(holds("K(f(a) = b) K(f(b) = b)", "K(f(a) = f(b))"));
  EXPECT_TRUE(holds("", "K(a != b) & !K(a = b)"));
  EXPECT_TRUE(holds("K(p(a)) K(p(b))", "forallK(?x : object) K(p(?x))"));
  EXPECT_FALSE(holds("K(p(a))", "forallK(?x : object) K(p(?x))"));
  EXPECT_TRUE(holds("K(p(a))", "existsK(?x : object) K(p(?x))"));
  EXPECT_TRUE(holds("K(p(a))", "K(p(a)) xor K(p(b))"));
  EXPECT_FALSE(holds("K(p(a)) K(p(b))", "K(p(a)) xor K(p(b))"));
  EXPECT_TRUE(holds("K(p(a)) LCW(p(?x))", "K(!p(b)) & LCW(p(?x))"));
  EXPECT_FALSE(holds("K(p(a))", "LCW(p(?x))"));
  EXPECT_TRUE(holds("Kx(p(a) | p(b)) K(!p(a))", "K(p(b))"));
  EXPECT_TRUE(holds("Kx(p(a) | p(b)) K(p(a))", "K(!p(b))"));
  EXPECT_TRUE(holds("Kx(f(a) = a | f(a) = b) K(f(a) != a)", "K(f(a) = b)"));
  EXPECT_TRUE(holds("K(p(a))", "K(p(a)) | K(p(b)) & false"));
}

TEST(Language, ExternsAreCalledOnlyWhereWhatStandsBeforeThemHolds) {
  std::string called;
  ExternalBindings bindings;
  bindings["g"] = [&](std::span<const std::string> arguments) {
    called += arguments[0];
    return std::string(arguments[0] == "a" ? "yes" : "");
  };
  const std::string text =
      kHead +
      "externals: g(object)\ninit: K(p(a)) K(!q(a)) K(!q(b))\n"
      "action act(?x : object) preconds: K(p(?x)) & extern(g(?x)) effects: add(Kf, q(?x))\n"
      "goal: K(q(a))";
  const Model m = load({"t.kpl", text, Language::Kpl}, nullptr, bindings);
  const Solution s = solve(m, {});
  ASSERT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(called, "aa");  // never for b, of which K(p(b)) fails; for a, and to confirm it
  EXPECT_TRUE(check(m, s.plan).valid);
}

TEST(Language, ExternValuesInEffects) {
  const std::string text =
      kHead +
      "externals: g(object) : object\ntable g: (a) = b\n"
      "action act(?x : object) preconds: true effects: add(Kf, f(?x) = extern(g(?x)))\n"
      "goal: K(f(a) = b) & K(f(a) = extern(g(a)))";
  const Model m = model_of(text);
  EXPECT_EQ(measure(m, solved(m, Algorithm::BreadthFirst).plan).longest, 1U);
}

TEST(Language, AnObjectMayBeCalledTable) {
  const Model m = model_of(
      "domain d\ntypes: tabletop, post\nconstants: tabletop table\nconstants: post stand\n"
      "predicates: p(tabletop)\n"
      "action act(?x : tabletop) preconds: true effects: add(Kf, p(?x))\ngoal: K(p(table))");
  EXPECT_EQ(measure(m, solved(m, Algorithm::BreadthFirst).plan).longest, 1U);
}

TEST(Language, EffectsDeleteFirstAndLookBack) {
  // Both conditions look at the state before the action: the two atoms swap.
  const Model m = model_of(kHead +
                           "init: K(p(a)) K(!p(b)) K(!r)\n"
                           "action swap preconds: true effects:\n"
                           "  K(p(a)) => { del(Kf, p(a)), add(Kf, p(b)), add(Kf, !p(a)) },\n"
                           "  K(p(b)) => { add(Kf, p(a)), add(Kf, !p(b)) }\n"
                           "goal: K(p(b)) & K(!p(a))");
  EXPECT_EQ(measure(m, solved(m, Algorithm::BreadthFirst).plan).longest, 1U);
}

}  // namespace
}  // namespace kaboum::plan::test
