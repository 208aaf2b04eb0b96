#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "task/formula.h"
#include "task/ground_action.h"
#include "task/layout.h"

namespace kaboum::plan {

/// A fluent with one of its contents: "p is known to be true", "f is known to be c", "p is
/// unknown".
using FactId = std::uint32_t;

/// The facts of a task, numbered, and what formulas and effects have to do with them.
class FactTable {
 public:
  /// @pre `layout` outlives it.
  FactTable(const Model& model, const Layout& layout);

  [[nodiscard]] FactId fact(Index fluent, Word content) const {
    return first_fact_[fluent] + static_cast<FactId>(std::min(content, contents_[fluent] - 1));
  }
  /// Number of contents told apart; of a handle, the last stands for all that come into being.
  [[nodiscard]] Word contents(Index fluent) const { return contents_[fluent]; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Index fluent_of(FactId f) const { return fluent_of_[f]; }
  [[nodiscard]] Word content_of(FactId f) const { return f - first_fact_[fluent_of_[f]]; }
  [[nodiscard]] bool holds(FactId f, const Word* state) const {
    return fact(fluent_of_[f], layout_.fluents()[fluent_of_[f]].get(state)) == f;
  }

  /// Facts of a leaf's fluent for which the leaf holds (or, if not positive, fails).
  /// @param always  set if it may do so whatever the content.
  [[nodiscard]] std::vector<FactId> leaf_contents(const FormulaPool::Node& leaf, bool positive,
                                                  bool& always) const;

  /// Facts that a change, or an effect, may bring about.
  [[nodiscard]] std::vector<FactId> added(const Change& change) const;
  [[nodiscard]] std::vector<FactId> added(const ConditionalEffect& effect) const;

  /// Whether the effect, where it happens, leaves the fluent with another content than `f` for
  /// certain, if nothing else that the action does gives it back.
  [[nodiscard]] bool ends(const ConditionalEffect& effect, FactId f) const;

 private:
  const Layout& layout_;
  std::size_t size_ = 0;
  std::vector<FactId> first_fact_;
  std::vector<Word> contents_;
  std::vector<Index> fluent_of_;
};

}  // namespace kaboum::plan
