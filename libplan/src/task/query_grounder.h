#pragma once

#include <kaboum/plan/model.h>

#include <vector>

#include "task/external_calls.h"
#include "task/formula.h"
#include "task/layout.h"
#include "task/rule_grounder.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// Makes ground formulas of queries of the model: variables get their objects, constant knowledge
/// is folded in.
class QueryGrounder {
 public:
  /// @pre all arguments outlive it.
  QueryGrounder(const Model& model, const Layout& layout, Limits& limits, FormulaPool& pool,
                ExternalCalls& calls, DerivedAtoms& derived)
      : model_(model),
        layout_(layout),
        limits_(limits),
        pool_(pool),
        calls_(calls),
        rules_(model, limits, pool, derived) {}

  /// The query for these slots; `let` gives its slot the call's number.
  Formula ground(const Query& query, std::vector<Index>& slots);
  /// What an argument stands for: an object, or an operand (answer_tree.h); kNone: nothing.
  [[nodiscard]] Index operand(const Argument& a, const std::vector<Index>& slots) const;

 private:
  /// The call that a query `extern(...)` makes, for these slots; kNone: it has no value.
  Index call_of(const Query& q, const std::vector<Index>& slots);
  Formula ground_connective(const Query& q, std::vector<Index>& slots);
  Formula ground_quantifier(const Query& q, std::vector<Index>& slots);
  Formula ground_atom(const Query& q, const std::vector<Index>& slots);
  Formula ground_term(const Query& q, const std::vector<Index>& slots);

  const Model& model_;
  const Layout& layout_;
  Limits& limits_;
  FormulaPool& pool_;
  ExternalCalls& calls_;
  RuleGrounder rules_;
  bool monotone_ = true;  ///< ground() is within no negation and no exclusive or
};

}  // namespace kaboum::plan
