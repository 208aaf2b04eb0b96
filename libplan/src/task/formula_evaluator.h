#pragma once

#include <cstdint>
#include <vector>

#include "task/derived_atoms.h"
#include "task/external_calls.h"
#include "task/formula.h"
#include "task/layout.h"

namespace kaboum::plan {

/// What a plan-time state says of a query: it stands for every way its sensed values may turn out.
/// Open: the query holds for some of them and fails for others.
/// Unresolved: an external function that it calls found nothing so far.
enum class Truth : std::uint8_t { No, Yes, Open, Unresolved };

/// Evaluates formulas of a pool in states; external functions are called as that needs them.
class FormulaEvaluator {
 public:
  /// @pre all arguments outlive it.
  FormulaEvaluator(const FormulaPool& pool, const Layout& layout, ExternalCalls& calls,
                   DerivedAtoms& derived)
      : pool_(pool), layout_(layout), calls_(calls), derived_(derived) {}

  /// Conjunctions and disjunctions are evaluated from left to right and stop at the first child
  /// that decides; an External is not called once an earlier child is open.
  [[nodiscard]] Truth evaluate(Formula f, const Word* state) const;
  [[nodiscard]] bool holds(Formula f, const Word* state) const {
    return evaluate(f, state) == Truth::Yes;
  }
  /// Fluents whose sensed value leaves `f` open in `state`.
  void open_fluents(Formula f, const Word* state, std::vector<Index>& out) const;

  /// Whether a call is in it whose answer can differ between states.
  [[nodiscard]] bool depends_on_calls(Formula f) const;

 private:
  /// Whether the External `f` is not called in `state`, for want of a known argument.
  [[nodiscard]] bool lacks_argument(Formula f, const Word* state) const;
  /// Undecided now, but a sensed atom of the same exclusive-or entries may decide it.
  [[nodiscard]] bool tied(Index fluent, AtomKnowledge k, const Word* state) const {
    return k == AtomKnowledge::Unknown && !layout_.fluents()[fluent].groups.empty() &&
           layout_.sensed_tie(fluent, state) != kNone;
  }
  [[nodiscard]] bool excluded(const Fluent& f, const Word* state, Index value) const {
    return f.exclusions != kNone && ((state[f.exclusions + value / 64] >> (value % 64)) & 1U) != 0;
  }

  const FormulaPool& pool_;
  const Layout& layout_;
  ExternalCalls& calls_;
  DerivedAtoms& derived_;
};

}  // namespace kaboum::plan
