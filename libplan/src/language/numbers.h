#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <optional>
#include <string>

#include "language/term_resolver.h"

namespace kaboum::plan {

/// A whole number from 0 to 1000000000; else nullopt.
std::optional<std::int64_t> whole_number(const std::string& text);

/// Sets the cost of an action: a number, or a numeric function of parameters and constants.
/// @throws Error{InvalidInput} at anything else.
void resolve_cost(const syntax::Term& cost, const TermResolver& terms, Scope& scope,
                  Action& action);

/// If the initial entry is f(constants) = number, notes that in `numbers` (as Model::numbers).
/// @return false if it is another entry. @throws Error{InvalidInput} if it is malformed.
bool resolve_number(const syntax::Effect& entry, const TermResolver& terms,
                    std::vector<std::map<std::vector<Index>, std::int64_t>>& numbers);

}  // namespace kaboum::plan
