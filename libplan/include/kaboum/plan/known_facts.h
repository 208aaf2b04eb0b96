#pragma once

#include <compare>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace kaboum::plan {

/// All that is known in a state of a run, by names: objects, and words of handles.
struct KnownFacts {
  /// A symbol, and its arguments.
  using Term = std::vector<std::string>;

  std::map<Term, bool> atoms;
  std::map<Term, std::string> values;              ///< of functions
  std::map<Term, std::set<std::string>> excluded;  ///< values that a function does not have
  std::vector<std::set<Term>> exclusive;           ///< of the atoms of each, one holds

  [[nodiscard]] auto operator<=>(const KnownFacts&) const = default;
};

}  // namespace kaboum::plan
