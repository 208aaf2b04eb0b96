// The validator, and whether it notices damage done to good plans.
#include "plan_test.h"

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
      EXPECT_FALSE(valid(m, broken)) << name << ": without " << step_text(m, plan.nodes[i].action);
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

TEST(Check, TreeAndGraphAreBothValid) {
  const Model m = scenario("bartender", "3");
  const Plan plan = good_plan(m);
  const Plan tree = expand_tree(plan);
  EXPECT_TRUE(valid(m, tree));
  EXPECT_EQ(measure(m, tree).tree_actions, measure(m, plan).tree_actions);
  EXPECT_GT(measure(m, tree).nodes, measure(m, plan).nodes);
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

}  // namespace
}  // namespace kaboum::plan::test
