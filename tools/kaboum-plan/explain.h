#pragma once

#include <kaboum/plan/failed_calls.h>
#include <kaboum/plan/goal_explanation.h>

#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// What is in the way of a task's goal.
struct Explanation {
  std::vector<plan::FailedCalls::Failure> failures;  ///< those of needed calls first
  plan::GoalExplanation goal;
};

/// @param solved  nothing is in the way of the goal
Explanation explain(const plan::Model& model, std::vector<plan::FailedCalls::Failure> failures,
                    const plan::SolveOptions& options, bool solved);

/// Why external functions returned no value, in a report.
Json failures_json(const Explanation& explanation);
/// What the goal needs and cannot have, in a report.
Json goal_json(const plan::GoalExplanation& goal);
/// Both for people, of failures those of needed calls and the most frequent ones; empty: there is
/// nothing to say.
std::string explanation_text(const Explanation& explanation);

}  // namespace kaboum::tools
