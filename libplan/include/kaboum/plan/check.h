#pragma once

#include <kaboum/plan/model.h>
#include <kaboum/plan/plan.h>

#include <cstdint>
#include <functional>
#include <string>

namespace kaboum::plan {

struct CheckResult {
  bool valid = false;
  std::string violation;     ///< what fails first, with the actions and outcomes that lead there
  std::uint64_t states = 0;  ///< pairs of a plan node and a knowledge state that were replayed
  std::uint64_t leaves = 0;  ///< distinct of those at an end of the plan
};

constexpr std::uint64_t kMostStates = 2'000'000;  ///< that `check` replays by default

/// Is told of each state that is replayed, how many there were; what it throws ends the work.
using CheckProgress = std::function<void(std::uint64_t states)>;

/// Whether an outcome of sensing that a plan has no case for is a violation, or whoever carries the
/// plan out stops there and plans again.
enum class MissingCases : std::uint8_t { Refused, PlannedAgain };

/// Replays a plan for every way the sensing may turn out: each precondition must hold, each branch
/// be on something known by then and have a case for its value, and each end meet the goal.
///
/// Shares the loaded model with the planner, and what is said of it. Knowledge is kept as sets of
/// literals at run time (a sensed value splits the replay when something looks at it), and as sets
/// of possible worlds where these know too little. Queries are evaluated on the lifted model. What
/// nothing further down reads is dropped, so shared sub-plans are replayed once for all that reach
/// them alike.
///
/// @throws Error{InvalidInput} if the graph has a cycle; Error{LimitReached} beyond `limit` pairs.
CheckResult check(const Model& model, const Plan& plan, std::uint64_t limit = kMostStates,
                  const CheckProgress& progress = {}, MissingCases missing = MissingCases::Refused);

}  // namespace kaboum::plan
