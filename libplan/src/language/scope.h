#pragma once

#include <kaboum/plan/model.h>

#include <string>
#include <vector>

#include "language/source.h"

namespace kaboum::plan {

/// Most variables of one action or goal: parameters, quantified ones, and those of unfolded terms.
inline constexpr std::size_t kMaximumSlots = 64;

/// Variables in scope: name, slot, type.
struct Scope {
  struct Variable {
    std::string name;
    Index slot;
    Index type;
  };
  std::vector<Variable> variables;
  Index slots = 0;
  SourceLocation location;  ///< of the action or goal, for messages

  Index fresh() {
    if (slots >= kMaximumSlots) location.fail("too many variables");
    return slots++;
  }
  [[nodiscard]] const Variable* find(const std::string& name) const {
    for (auto v = variables.rbegin(); v != variables.rend(); ++v)
      if (v->name == name) return &*v;
    return nullptr;
  }
};

}  // namespace kaboum::plan
