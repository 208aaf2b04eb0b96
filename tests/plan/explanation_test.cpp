// What is said to be in the way of goals: proved, so never said where there is a plan.
#include <kaboum/plan/goal_explanation.h>

#include "plan_test.h"
#include "random_model.h"

namespace kaboum::plan::test {
namespace {

using Pair = std::pair<std::string, std::string>;

const std::string kMove =
    "types: thing, place\nconstants: thing t; place a, b, c\n"
    "predicates: at(thing, place), lit(place)\nfunctions: in(thing) : place\n"
    "action move(?t : thing, ?a : place, ?b : place) preconds: K(at(?t, ?a)) & K(?a != ?b)\n"
    "effects: del(Kf, at(?t, ?a)), add(Kf, at(?t, ?b))\n"
    "action put(?t : thing, ?a : place) effects: add(Kf, in(?t) = ?a)\n"
    "action light(?a : place) preconds: K(lit(?a)) effects: add(Kf, lit(?a))\n"
    "init: K(at(t, a))\ngoal: ";

TEST(Explanation, GoalsThatContradictEachOther) {
  const auto of = [](const std::string& goal) {
    return explain_goal(model_of(kMove + goal), {}, {});
  };
  const GoalExplanation two = of("K(at(t, b)) & K(at(t, c)) & K(in(t) = a)");
  EXPECT_EQ(two.exclusive, (std::vector{Pair{"K(at(t, b))", "K(at(t, c))"}}));
  EXPECT_TRUE(two.unreachable.empty());
  EXPECT_FALSE(two.never);
  EXPECT_EQ(of("K(at(t, b)) & K(lit(b))").unreachable, std::vector<std::string>{"K(lit(b))"});
  const GoalExplanation values = of("K(in(t) = a) & K(in(t) = b)");
  EXPECT_TRUE(values.never || values.exclusive.size() == 1);
  const GoalExplanation good = of("K(at(t, b)) & K(in(t) = c)");
  EXPECT_TRUE(!good.never && good.unreachable.empty() && good.exclusive.empty());
}

TEST(Explanation, NothingIsSaidWhereThereIsAPlan) {
  int solved = 0, explained = 0;
  for (std::uint32_t seed = 0; seed < 1500; ++seed) {
    const std::string text = Generator(seed, seed % 4 == 0).model(3, 1);
    const Model m = model_of(text);
    SolveOptions options;
    options.timeout = 20;
    const GoalExplanation e = explain_goal(m, {}, options);
    const bool says = e.never || !e.unreachable.empty() || !e.exclusive.empty();
    const Solution s = solve(m, options);
    if (s.outcome == Outcome::Solved) {
      EXPECT_FALSE(says) << "seed " << seed << "\n" << text;
      ++solved;
    }
    explained += says ? 1 : 0;
  }
  EXPECT_GT(solved, 300);
  EXPECT_GT(explained, 50);
  std::cout << "solved " << solved << ", explained " << explained << "\n";
}

TEST(Explanation, CallsThatEveryPlanNeeds) {
  const std::string text =
      "types: door\nconstants: door front, back, side\npredicates: in, out, seen(door)\n"
      "externals: open(door); look(door)\n"
      "table open: (front)\ntable look: (front)\n"
      "action enter(?d : door) preconds: K(seen(?d)) & extern(open(?d)) effects: add(Kf, in)\n"
      "action look(?d : door) preconds: extern(look(?d)) effects: add(Kf, seen(?d))\n"
      "action leave preconds: K(in) & extern(open(back)) effects: add(Kf, out)\n"
      "init: K(!in), K(!out)\ngoal: K(out)";
  ExternalBindings b;
  const auto answers = [](const Question&) { return Answer::impossible("shut"); };
  b["open"] = answers;
  b["look"] = answers;
  std::string unbound = text;
  unbound.erase(unbound.find("table"), unbound.find("action enter") - unbound.find("table"));
  const Model m = load({"t.kpl", unbound, Language::Kpl}, nullptr, b);
  const GoalExplanation e =
      explain_goal(m, {"open(front)", "open(back)", "look(side)", "open(attic)"}, {});
  EXPECT_EQ(e.needed, std::set<std::string>{"open(back)"});
}

}  // namespace
}  // namespace kaboum::plan::test
