// One call of the planner: the task is made, a planner run, limits become an outcome.
#include <kaboum/base/error.h>
#include <kaboum/plan/solve.h>

#include <algorithm>

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

/// Searches, and again with more samples while that fails and some call found nothing.
void search(Task& task, const SolveOptions& options, Limits& limits, Solution& solution) {
  ExternalCalls& calls = task.calls();
  calls.seed(options.seed);
  while (true) {
    ContingentPlanner planner(task, search_function(options.algorithm), limits,
                              solution.statistics);
    solution.outcome = planner.run();
    if (solution.outcome == Outcome::Solved) {
      solution.plan = planner.plan();
      const auto& functions = task.model().external_functions;
      if (std::any_of(functions.begin(), functions.end(),
                      [](const auto& f) { return f.reads_state; })) {
        solution.plan.seed = options.seed;
        solution.plan.attempts = calls.attempts();
      }
    }
    if (solution.outcome != Outcome::Unsolvable || calls.missed().empty()) break;
    if (calls.attempts() >= options.attempts) {
      solution.outcome = Outcome::Limit;
      solution.limit = "an external function found nothing in " + std::to_string(calls.attempts()) +
                       (calls.attempts() == 1 ? " attempt, " : " attempts, ") + calls.missed();
      return;
    }
    calls.try_again();
  }
  if (solution.outcome != Outcome::Limit) calls.confirm();
}

}  // namespace

Solution solve(const Model& model, const SolveOptions& options) {
  Solution solution;
  Limits limits(options, solution.statistics);
  try {
    Task task(model, limits);
    const auto count = [&] {
      solution.statistics.ground_actions = task.action_count();
      solution.statistics.external_calls = task.calls().calls_made();
      solution.statistics.external_bytes = task.calls().bytes();
      solution.statistics.external_seconds = task.calls().seconds();
    };
    try {
      search(task, options, limits, solution);
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
  if (solution.outcome == Outcome::Limit && solution.limit.empty())
    solution.limit =
        limits.reason().empty() ? "depth limit of nested searches reached" : limits.reason();
  return solution;
}

}  // namespace kaboum::plan
