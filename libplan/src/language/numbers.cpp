// Numbers: costs of actions, and initial values of the functions that costs are looked up in.
#include "language/numbers.h"

#include <charconv>

namespace kaboum::plan {
namespace {

/// nullptr: the term is no numeric function.
const Index* numeric_function(const syntax::Term& t, const SymbolTable& symbols) {
  const Index* function = symbols.function_of(t);
  return function != nullptr && symbols.model().functions[*function].numeric ? function : nullptr;
}

}  // namespace

std::optional<std::int64_t> whole_number(const std::string& text) {
  constexpr std::int64_t kLargest = 1'000'000'000;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > kLargest)
    return std::nullopt;
  return value;
}

void resolve_cost(const syntax::Term& cost, const TermResolver& terms, Scope& scope,
                  Action& action) {
  if (const auto value = whole_number(cost.name.text)) {
    action.cost = *value;
    return;
  }
  const Index* function = numeric_function(cost, terms.symbols());
  if (function == nullptr)
    cost.name.location.fail(
        "a cost is a whole number from 0 to 1000000000 or a function of type number");
  std::vector<Unfolded> unfolded;
  action.cost_function = *function;
  action.cost_arguments =
      terms.arguments(cost, terms.symbols().model().functions[*function], scope, unfolded);
  if (!unfolded.empty()) cost.name.location.fail("a cost's arguments are parameters and constants");
}

bool resolve_number(const syntax::Effect& entry, const TermResolver& terms,
                    std::vector<std::map<std::vector<Index>, std::int64_t>>& numbers) {
  const syntax::Formula& f = entry.formulas.at(0);
  if (f.kind != syntax::Formula::Kind::Equal) return false;
  const Index* function = numeric_function(f.terms.at(0), terms.symbols());
  if (function == nullptr) return false;
  Scope none;
  std::vector<Unfolded> unfolded;
  std::vector<Index> key;
  const Symbol& symbol = terms.symbols().model().functions[*function];
  for (const Argument& a : terms.arguments(f.terms[0], symbol, none, unfolded))
    key.push_back(a.index);
  if (!unfolded.empty()) f.location.fail("an initial value's arguments are constants");
  const auto value = whole_number(f.terms.at(1).name.text);
  if (!value) f.terms[1].name.location.fail("expected a whole number from 0 to 1000000000");
  numbers[*function][key] = *value;
  return true;
}

}  // namespace kaboum::plan
