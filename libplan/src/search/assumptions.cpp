// Outcomes of sensing that plans have branches for.
#include "search/assumptions.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <vector>

namespace kaboum::plan {
namespace {

[[noreturn]] void refuse_assumption(const std::string& text, const std::string& what) {
  throw Error(ErrorCode::InvalidArgument, "it is assumed of '" + text + "', " + what);
}

/// The name of "p(a, b)" and its arguments.
std::vector<std::string> parts_of_name(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == '(' || c == ',') out.emplace_back();
    if (c != '(' && c != ',' && c != ')' && c != ' ') out.back() += c;
  }
  if (out.size() == 2 && out.back().empty()) out.pop_back();  // "p()"
  return out;
}

std::vector<Index> assumed_objects(const Model& model, const std::string& text,
                                   const std::vector<std::string>& parts, const Symbol& symbol) {
  if (parts.size() - 1 != symbol.parameters.size())
    refuse_assumption(text, "which has other arguments");
  std::vector<Index> out;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto object = std::ranges::find(model.objects, parts[i], &Object::name);
    if (object == model.objects.end())
      refuse_assumption(text, "but there is no '" + parts[i] + "'");
    out.push_back(static_cast<Index>(object - model.objects.begin()));
  }
  return out;
}

}  // namespace

Assumptions::Assumptions(Task& task, const std::map<std::string, std::string>& stated)
    : task_(task) {
  const Model& model = task.model();
  for (const auto& [text, value] : stated) {
    const std::vector<std::string> parts = parts_of_name(text);
    const auto predicate = std::ranges::find(model.predicates, parts[0], &Symbol::name);
    if (predicate != model.predicates.end()) {
      if (value != "true" && value != "false")
        refuse_assumption(text, "which is true or false, not " + value);
      const Layout::Field at =
          task.layout().atom(static_cast<Index>(predicate - model.predicates.begin()),
                             assumed_objects(model, text, parts, *predicate).data());
      if (at.fluent != kNone)
        outcomes_[at.fluent] = task.outcome_id(at.fluent, value == "true" ? 1 : 0);
      continue;
    }
    const auto function = std::ranges::find(model.functions, parts[0], &Symbol::name);
    if (function == model.functions.end()) refuse_assumption(text, "which the model does not have");
    const Layout::Field at =
        task.layout().term(static_cast<Index>(function - model.functions.begin()),
                           assumed_objects(model, text, parts, *function).data());
    const std::vector<Index>& range = model.types[function->range].objects;
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
