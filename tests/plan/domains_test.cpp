// The scenarios of the thesis: known plan lengths, sizes of the plan graphs.
#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

class Stacked : public testing::TestWithParam<int> {};

TEST_P(Stacked, ShortestPlanHas2nMinus1Moves) {
  const int n = GetParam();
  for (const char* seed : {"", " 1", " 2"}) {
    const Model m = scenario("stacked", std::to_string(n) + seed);
    for (const Algorithm a :
         {Algorithm::BreadthFirst, Algorithm::IterativeDeepening, Algorithm::AStar}) {
      const Solution s = solved(m, a);
      ASSERT_EQ(s.outcome, Outcome::Solved);
      EXPECT_EQ(measure(m, s.plan).longest, static_cast<std::uint64_t>(2 * n - 1));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Sizes, Stacked, testing::Values(2, 3, 4, 5, 6));

TEST(Scenario, StackedOf20IsSolvedOptimallyWithAnyNames) {
  for (const char* arguments : {"20", "20 5", "20 6"}) {
    const Model m = scenario("stacked", arguments);
    const Solution s = solved(m, Algorithm::AStar);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    EXPECT_EQ(measure(m, s.plan).longest, 39U);
  }
}

TEST(Scenario, AStateOfStacked8TakesAtMost40Bytes) {
  const Model m = scenario("stacked", "8");
  SolveOptions options;
  const Solution s = solve(m, options);
  ASSERT_EQ(s.outcome, Outcome::Solved);
  EXPECT_LE(s.statistics.state_bytes, 40 * s.statistics.states);
}

TEST(Scenario, ForceSensingSharesSubPlans) {
  for (const int n : {1, 2, 3, 10, 50}) {
    const Model m = scenario("force-sensing", std::to_string(n));
    const Solution s = solved(m, Algorithm::DepthFirst);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    const PlanSize size = measure(m, s.plan);
    EXPECT_EQ(size.nodes, static_cast<std::uint64_t>(5 * n));
    if (n <= 10) {
      EXPECT_EQ(size.tree_actions, 6 * (std::uint64_t{1} << n) - 6);
    }
  }
}

TEST(Scenario, BartenderCoversEveryOutcome) {
  for (const int n : {1, 2, 4, 6}) {
    const Model m = scenario("bartender", std::to_string(n));
    const Solution s = solved(m, Algorithm::Greedy);
    ASSERT_EQ(s.outcome, Outcome::Solved);
    EXPECT_EQ(measure(m, s.plan).leaves, std::uint64_t{1} << n);
  }
}

TEST(Scenario, AssemblyTakesSixActionsAsInTable67) {
  const Model m = scenario("bimanual-assembly", "1");
  for (const Algorithm a : {Algorithm::BreadthFirst, Algorithm::AStar})
    EXPECT_EQ(measure(m, solved(m, a).plan).longest, 6U);
}

TEST(Scenario, CircularRearrangeOptimaAgree) {
  for (const int n : {2, 3, 4}) {
    const Model m = scenario("circular-rearrange", std::to_string(n));
    const std::uint64_t shortest = measure(m, solved(m, Algorithm::BreadthFirst).plan).longest;
    EXPECT_EQ(measure(m, solved(m, Algorithm::AStar).plan).longest, shortest);
    EXPECT_EQ(measure(m, solved(m, Algorithm::IterativeDeepening).plan).longest, shortest);
  }
}

TEST(Scenario, RemoveTakesOneActionPerObject) {
  const Model m = scenario("remove", "12");
  for (const Algorithm a : kAll) EXPECT_EQ(measure(m, solved(m, a).plan).longest, 12U);
}

TEST(Scenario, EveryScenarioIsSolvedByEverySearch) {
  for (const char* name :
       {"stacked", "force-sensing", "bartender", "circular-rearrange", "remove"}) {
    const Model m = scenario(name, "2");
    for (const Algorithm a : kAll) EXPECT_EQ(solved(m, a).outcome, Outcome::Solved) << name;
  }
}

}  // namespace
}  // namespace kaboum::plan::test
