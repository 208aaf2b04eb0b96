#pragma once

#include <utility>
#include <vector>

#include "task/external_calls.h"
#include "task/formula_evaluator.h"
#include "task/ground_action.h"
#include "task/knowledge.h"
#include "task/layout.h"

namespace kaboum::plan {

/// Makes the effects of ground actions on states.
class ActionEffects {
 public:
  /// @pre all arguments outlive it.
  ActionEffects(const Layout& layout, const FormulaEvaluator& evaluator, ExternalCalls& calls)
      : layout_(layout), evaluator_(evaluator), calls_(calls) {}

  /// @param supposed  calls are not made, what they return is unknown.
  /// @return false if an observation contradicts what is known, or a call has no value; the state
  /// is then meaningless.
  bool make(const GroundAction& action, Knowledge& state, bool supposed);

 private:
  bool take(const ConditionalEffect::Transfer& t, const Word* state, bool supposed);

  const Layout& layout_;
  const FormulaEvaluator& evaluator_;
  ExternalCalls& calls_;
  std::vector<std::pair<Index, Word>> taken_;  ///< contents that transfers take over
};

}  // namespace kaboum::plan
