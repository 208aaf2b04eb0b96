#pragma once

#include <kaboum/plan/model.h>

#include <memory>
#include <vector>

#include "task/action_effects.h"
#include "task/action_schema.h"
#include "task/effect_grounder.h"
#include "task/formula_evaluator.h"
#include "task/ground_action.h"
#include "task/knowledge.h"
#include "task/layout.h"
#include "task/outcome_table.h"
#include "task/query_grounder.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// A model made ready for search. Ground actions come into being when they are first reached.
class Task {
 public:
  /// @throws LimitExceeded, as may all that grounds, when `limits` are reached.
  Task(const Model& model, Limits& limits);
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] FormulaPool& pool() { return pool_; }
  [[nodiscard]] const FormulaPool& pool() const { return pool_; }
  [[nodiscard]] const FormulaEvaluator& evaluator() const { return evaluator_; }
  [[nodiscard]] QueryGrounder& queries() { return queries_; }
  [[nodiscard]] ExternalCalls& calls() { return calls_; }
  [[nodiscard]] const DerivedAtoms& derived() const { return derived_; }
  [[nodiscard]] const std::vector<Word>& initial() const { return initial_; }
  [[nodiscard]] Formula goal() const { return goal_; }

  /// Steps possible in a state: applicable actions in order of declaration and arguments; then, for
  /// sensed values that the goal or an otherwise applicable action needs decided, their outcomes;
  /// then, when branching anywhere, the outcomes of all other sensed values that something reads.
  void expand(const Word* state, std::vector<OperatorId>& steps) { expand(state, steps, false); }
  /// The same, but that no external function is asked about the state: what it would say is taken
  /// for granted. A step that `asks` is possible only if `decide` says so.
  void expand_unasked(const Word* state, std::vector<OperatorId>& steps) {
    expand(state, steps, true);
  }
  /// Of an action whose precondition holds, without sensing: whether it is known, so far as
  /// external functions go, which effects happen, or is put off until it `asks`.
  [[nodiscard]] bool settled(const Word* state, OperatorId step) const;
  [[nodiscard]] bool asks(OperatorId step) const {
    return !is_outcome(step) && actions_[step]->asks;
  }
  /// Makes the calls of a step of `expand_unasked`. @return whether it is possible.
  /// @param outcomes  where sensed values leave that open: their outcomes are appended.
  bool decide(const Word* state, OperatorId step, std::vector<OperatorId>& outcomes);

  /// To branch only on need keeps searches small but loses plans: which of two actions to take may
  /// depend on a value that is tested later. So a search on need that fails proves nothing if a
  /// branch was pruned.
  enum class Branching { OnNeed, Anywhere };
  void branch(Branching b) { branching_ = b; }
  [[nodiscard]] bool pruned_branch() const { return pruned_branch_; }

  /// How often `decide` was false for good, whatever may be sensed.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

  /// Makes the step. @return false if an outcome or observation contradicts what is known; the
  /// state is then meaningless and the step not possible.
  bool apply(OperatorId step, Knowledge& state);

  /// What a step that `asks` would make of the state if it were possible: what calls return is
  /// unknown. @return false: that cannot be told.
  bool suppose(OperatorId step, Knowledge& state);

  [[nodiscard]] bool is_outcome(OperatorId step) const { return OutcomeTable::contains(step); }
  [[nodiscard]] const GroundAction& action(OperatorId step) const { return *actions_[step]; }
  using SensingOutcome = OutcomeTable::Outcome;
  [[nodiscard]] SensingOutcome outcome(OperatorId step) const { return outcomes_[step]; }
  OperatorId outcome_id(Index fluent, Index value) { return outcomes_.id(fluent, value); }
  /// Every outcome of sensing this fluent in this state.
  [[nodiscard]] std::vector<Index> outcomes(Index fluent, const Word* state) const;
  [[nodiscard]] std::int64_t cost(OperatorId step) const {
    return is_outcome(step) ? 0 : actions_[step]->cost;
  }
  [[nodiscard]] std::size_t action_count() const { return actions_.size(); }

  /// The ground action with these arguments (made if need be); its precondition is not looked at.
  OperatorId action_id(Index schema, const std::vector<Index>& arguments);

  [[nodiscard]] std::uint64_t tests() const { return tests_; }  ///< action instances tested so far

  [[nodiscard]] ActionSchema& schema(Index s) { return schemas_[s]; }

 private:
  template <bool Sensing>
  class Expansion;

  [[nodiscard]] bool resolved(const GroundAction& action, const Word* state) const;
  [[nodiscard]] std::int64_t cost_of(const Action& a, const std::vector<Index>& slots) const;
  template <bool Sensing>
  void expand_actions(const Word* state, std::vector<OperatorId>& steps, bool unasked);
  void expand(const Word* state, std::vector<OperatorId>& steps, bool unasked);

  const Model& model_;
  Limits& limits_;
  Layout layout_;
  ExternalCalls calls_;
  FormulaPool pool_;
  DerivedAtoms derived_;
  FormulaEvaluator evaluator_;
  QueryGrounder queries_;
  std::vector<Word> initial_;
  Formula goal_ = kTrue;
  EffectGrounder grounder_;
  ActionEffects effects_;
  std::vector<ActionSchema> schemas_;
  std::vector<std::unique_ptr<GroundAction>> actions_;
  OutcomeTable outcomes_;
  std::vector<Index> slots_;
  std::vector<Index> needs_;
  std::vector<Index> sensible_;  ///< fluents whose sensed value some query reads, or Kx ties to one
  Branching branching_ = Branching::OnNeed;
  bool pruned_branch_ = false;  ///< a branch was possible that nothing needed
  std::uint64_t tests_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace kaboum::plan
