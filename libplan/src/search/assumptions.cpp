// Outcomes of sensing that plans have branches for.
#include "search/assumptions.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <vector>

#include "plan/named_fact.h"

namespace kaboum::plan {
namespace {

[[noreturn]] void refuse_assumption(const std::string& text, const std::string& what) {
  throw Error(ErrorCode::InvalidArgument, "it is assumed of '" + text + "', " + what);
}

}  // namespace

Assumptions::Assumptions(Task& task, const std::map<std::string, std::string>& stated)
    : task_(task) {
  const Model& model = task.model();
  for (const auto& entry : stated) {
    const std::string& text = entry.first;  // no bindings: Clang 14 does not capture them
    const std::string& value = entry.second;
    const NamedFact fact = read_named_fact(
        model, text, value, [&](const std::string& what) { refuse_assumption(text, what); });
    if (!fact.function) {
      const Layout::Field at = task.layout().atom(fact.symbol, fact.arguments.data());
      if (at.fluent != kNone)
        outcomes_[at.fluent] = task.outcome_id(at.fluent, value == "true" ? 1 : 0);
      continue;
    }
    const Layout::Field at = task.layout().term(fact.symbol, fact.arguments.data());
    const std::vector<Index>& range = model.types[model.functions[fact.symbol].range].objects;
    const auto object =
        std::ranges::find_if(range, [&](Index o) { return model.objects[o].name == value; });
    if (object == range.end()) refuse_assumption(text, "but '" + value + "' is no value of it");
    if (at.fluent != kNone)
      outcomes_[at.fluent] = task.outcome_id(at.fluent, static_cast<Index>(object - range.begin()));
  }
}

bool Assumptions::expects(const Word* state, OperatorId outcome) const {
  if (outcomes_.empty()) return true;
  const auto assumed = outcomes_.find(task_.outcome(outcome).fluent);
  if (assumed == outcomes_.end() || assumed->second == outcome) return true;
  Knowledge k(task_.layout());
  k.assign(state);
  return !task_.apply(assumed->second, k);
}

}  // namespace kaboum::plan
