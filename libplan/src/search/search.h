#pragma once

#include <kaboum/plan/solve.h>

#include <memory>
#include <vector>

#include "task/solve_limits.h"
#include "task/task.h"

namespace kaboum::plan {

class ApplicableSteps;
class Relaxation;
class RelaxedPlan;
class Invariants;
class LandmarkHeuristic;

/// What a search for one unbranched part looks for, and which outcomes it may suppose.
class Target {
 public:
  virtual ~Target() = default;
  virtual bool reached(const Word* state) = 0;
  /// Whether branching on this outcome's fluent in this state is still worth trying.
  virtual bool allowed(const Word* state, OperatorId outcome) = 0;
  /// Whether a plan needs a branch for this outcome; others are assumed not to happen.
  virtual bool expects(const Word* state, OperatorId outcome) = 0;
};

/// How a search ended, and the steps that it found.
struct SearchResult {
  Outcome outcome = Outcome::Limit;
  std::vector<OperatorId> steps;
};

/// Heuristics of a task, and what else searches share, made when a search first needs them and kept
/// for the next.
struct Heuristics {
  Heuristics();
  ~Heuristics();
  RelaxedPlan& relaxed(Task& task, Limits& limits);
  LandmarkHeuristic& landmark(Task& task, Limits& limits);
  ApplicableSteps& steps(Task& task, Limits& limits);
  void prepare(Task& task, Limits& limits);
  std::unique_ptr<Relaxation> relaxation;
  std::unique_ptr<RelaxedPlan> relaxed_plan;
  std::unique_ptr<Invariants> invariants;
  std::unique_ptr<LandmarkHeuristic> landmarks;
  std::unique_ptr<ApplicableSteps> applicable;
  Formula goal = kTrue;  ///< the task's, without what no reachable state has
};

/// One search from `start` to the target. The algorithm's header tells what it guarantees.
struct SearchInput {
  Task& task;
  const std::vector<Word>& start;
  Target& target;
  Limits& limits;
  Statistics& statistics;
  Heuristics& heuristics;
};

SearchResult depth_first(const SearchInput& in);
SearchResult breadth_first(const SearchInput& in);
SearchResult iterative_deepening(const SearchInput& in);
SearchResult greedy_best_first(const SearchInput& in);
SearchResult a_star(const SearchInput& in);

}  // namespace kaboum::plan
