#pragma once

#include <kaboum/plan/model.h>

#include <functional>
#include <string>
#include <vector>

namespace kaboum::plan {

/// A ground atom or function term.
struct NamedFact {
  bool function = false;
  Index symbol = 0;
  std::vector<Index> arguments;  ///< objects
};

/// Reads "p", "p()" or "p(a, b)", with blanks round names; and looks at the value that goes with
/// it, which of an atom is "true" or "false".
/// @param refuse  throws, given what is wrong: "which the model does not have".
NamedFact read_named_fact(const Model& model, const std::string& text, const std::string& value,
                          const std::function<void(const std::string&)>& refuse);

}  // namespace kaboum::plan
