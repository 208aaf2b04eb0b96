#pragma once

#include <kaboum/plan/solve.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::plan {

/// What is in the way of a goal whatever order actions are made in: proved, and by far not all that
/// may be in the way.
struct GoalExplanation {
  bool never = false;  ///< the goal is false in every state
  /// Facts that the goal needs and that no actions bring about, whatever external functions answer:
  /// "K(at(a))", "K(f(a) = b)".
  std::vector<std::string> unreachable;
  /// Facts that the goal needs of which no state that can be reached has both.
  std::vector<std::pair<std::string, std::string>> exclusive;
  /// Calls, of those that were asked about, that every plan needs a value of.
  std::set<std::string> needed;
};

/// By the delete relaxation and by invariants (docs/planning/search.md). Of a model of which the
/// knowledge states lose something nothing is said.
/// @param calls  "fetch(arm, o1, home)"; at most 64 of those that the task makes are looked at
/// @param options  its limits of time and memory hold; when one is reached, the rest is not said.
/// @throws Error as `solve` does.
GoalExplanation explain_goal(const Model& model, const std::set<std::string>& calls,
                             const SolveOptions& options);

}  // namespace kaboum::plan
