// One call of the planner: the task is made, a planner run, limits become an outcome.
#include <kaboum/base/error.h>
#include <kaboum/plan/solve.h>

#include "search/contingent.h"
#include "search/search.h"
#include "task/exactness.h"
#include "task/task.h"

namespace kaboum::plan {
namespace {

ContingentPlanner::SearchFunction search_function(Algorithm a) {
  switch (a) {
    case Algorithm::DepthFirst:
      return depth_first;
    case Algorithm::BreadthFirst:
      return breadth_first;
    case Algorithm::IterativeDeepening:
      return iterative_deepening;
    case Algorithm::Greedy:
      return greedy_best_first;
    case Algorithm::AStar:
      return a_star;
  }
  throw Error(ErrorCode::InvalidArgument, "unknown search algorithm");
}

}  // namespace

Solution solve(const Model& model, const SolveOptions& options) {
  Solution solution;
  Limits limits(options, solution.statistics);
  try {
    Task task(model, limits);
    const auto count = [&] {
      solution.statistics.ground_actions = task.action_count();
      solution.statistics.external_calls = task.pool().external_calls();
      solution.statistics.external_seconds = task.pool().external_seconds();
    };
    try {
      ContingentPlanner planner(task, search_function(options.algorithm), limits,
                                solution.statistics);
      solution.outcome = planner.run();
      if (solution.outcome == Outcome::Solved) solution.plan = planner.plan();
      if (solution.outcome != Outcome::Limit) task.pool().confirm_calls();
    } catch (const LimitExceeded&) {
      count();
      throw;
    }
    count();
  } catch (const LimitExceeded&) {
    solution.outcome = Outcome::Limit;
  }
  if (solution.outcome == Outcome::Unsolvable) {
    solution.lost = lost_knowledge(model);
    if (!solution.lost.empty()) solution.outcome = Outcome::NotInferred;
  }
  if (solution.outcome == Outcome::Limit)
    solution.limit =
        limits.reason().empty() ? "depth limit of nested searches reached" : limits.reason();
  return solution;
}

}  // namespace kaboum::plan
