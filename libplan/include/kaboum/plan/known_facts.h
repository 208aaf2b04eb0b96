#pragma once

#include <compare>
#include <map>
#include <set>
#include <string>
#include <utility>
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
  /// Clauses: at least one literal of each, an atom and its truth, holds.
  std::vector<std::set<std::pair<Term, bool>>> some;
  /// More is known than this says: an action has changed an atom of disjunctions that tied others
  /// to each other, or what hangs together that actions may have changed is not kept.
  bool cut = false;

  // NOLINTNEXTLINE(modernize-use-nullptr): what the compiler makes of it is compared with 0
  [[nodiscard]] auto operator<=>(const KnownFacts&) const = default;
};

/// "isSpillable(o1)", "place(o2)".
std::string text_of(const KnownFacts::Term& term);

/// What is known, a sentence each: "isSpillable(o1)", "!isSpillable(o1)", "place(o2) = shelf",
/// "place(o2) != shelf", "one of a(x), b(y)", "a(x) or !b(y)".
std::set<std::string> sentences_of(const KnownFacts& known);

}  // namespace kaboum::plan
