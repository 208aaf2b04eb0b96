// What is in the way of a goal: what it needs, and which calls of external functions failed, how
// often, and why.

#include "explain.h"

#include <algorithm>
#include <set>
#include <utility>

namespace kaboum::tools {
namespace {

using Failures = std::vector<plan::FailedCalls::Failure>;

constexpr std::size_t kShown = 12;  // failures that are told

const char* verdict_of(const plan::FailedCalls::Failure& f) {
  return f.impossible ? "impossible" : "not found";
}

}  // namespace

Explanation explain(const plan::Model& model, Failures failures, const plan::SolveOptions& options,
                    bool solved) {
  Explanation out;
  if (!solved) {
    std::set<std::string> calls;
    for (const auto& f : failures) calls.insert(f.call);
    out.goal = plan::explain_goal(model, calls, options);
    std::stable_partition(failures.begin(), failures.end(),
                          [&](const auto& f) { return out.goal.needed.contains(f.call); });
  }
  out.failures = std::move(failures);
  return out;
}

Json failures_json(const Explanation& explanation) {
  Json out = Json::array();
  for (const auto& f : explanation.failures)
    out.push_back({{"call", f.call},
                   {"reason", f.reason},
                   {"times", f.times},
                   {"verdict", verdict_of(f)},
                   {"needed", explanation.goal.needed.contains(f.call)}});
  return out;
}

Json goal_json(const plan::GoalExplanation& goal) {
  return {{"never", goal.never}, {"unreachable", goal.unreachable}, {"exclusive", goal.exclusive}};
}

std::string explanation_text(const Explanation& explanation) {
  const plan::GoalExplanation& goal = explanation.goal;
  std::string facts;
  if (goal.never) facts += "  it is false in every state\n";
  for (const std::string& fact : goal.unreachable)
    facts += "  " + fact + ": no actions bring it about\n";
  for (std::size_t i = 0; i < std::min(kShown, goal.exclusive.size()); ++i)
    facts += "  " + goal.exclusive[i].first + " and " + goal.exclusive[i].second +
             ": no state that can be reached has both\n";
  std::string out = facts.empty() ? facts : "what is in the way of the goal:\n" + facts;
  const Failures& failures = explanation.failures;
  if (!failures.empty()) out += "calls that returned no value:\n";
  for (std::size_t i = 0; i < std::min(kShown, failures.size()); ++i) {
    const plan::FailedCalls::Failure& f = failures[i];
    out += "  " + f.call + ": " + verdict_of(f) + ", " + std::to_string(f.times) +
           (f.times == 1 ? " time" : " times") +
           (goal.needed.contains(f.call) ? ", and every plan needs one: " : ": ") + f.reason + "\n";
  }
  if (failures.size() > kShown)
    out += "  and " + std::to_string(failures.size() - kShown) + " more (--report names all)\n";
  return out;
}

}  // namespace kaboum::tools
