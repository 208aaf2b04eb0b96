// The steps that are possible in a state: instances of actions by descent over their parameters,
// each conjunct tested as soon as it can be, and outcomes of sensing.
#include "task/task.h"

#include <algorithm>
#include <array>

#include "task/sensing.h"

namespace kaboum::plan {

/// One look at all instances of the actions. Sensing: queries may be open; what they wait for is
/// gathered in Task::needs_. Unasked: what external functions say of the state is taken for
/// granted.
template <bool Sensing>
class Task::Expansion {
 public:
  Expansion(Task& task, const Word* state, std::vector<OperatorId>& steps, bool unasked)
      : task_(task), state_(state), steps_(steps), slots_(task.slots_.data()), unasked_(unasked) {}

  void expand(Index schema) {
    number_ = schema;
    schema_ = &task_.schemas_[schema];
    open_count_ = 0;
    for (ActionSchema::Check& c : schema_->constant())
      if (!test(schema_->grounded(c, slots_))) return;
    arguments_.assign(schema_->levels().size(), 0);
    descend(0);
  }

  /// Whether it is the same for every way that sensed values may turn out, and known so far as
  /// external functions go, which effects happen.
  bool settled(const GroundAction& action) {
    if constexpr (Sensing) return decided(action);
    return task_.resolved(action, state_);
  }

 private:
  /// false: prune. Open formulas are remembered and the descent goes on.
  bool test(Formula f) {
    if (f == kTrue) return true;
    if (f == kFalse) return false;
    if (unasked_ && task_.pool_.node(f).calls && task_.evaluator_.depends_on_calls(f)) return true;
    if constexpr (!Sensing) return task_.evaluator_.holds(f, state_);
    if (open_count_ > 0 && task_.pool_.node(f).calls)
      return true;  // not called before the rest is decided
    const Truth t = task_.evaluator_.evaluate(f, state_);
    if (t == Truth::Open && open_count_ < open_.size()) open_[open_count_++] = f;
    return t == Truth::Yes || t == Truth::Open;
  }

  bool test(const ActionSchema::Candidate& c) {
    if (c.test.mask != 0) {
      if (c.test.holds(state_)) return true;
      if (!Sensing) return false;
    }
    return test(c.full);
  }

  void descend(std::size_t depth) {
    if (depth == arguments_.size()) {
      instance();
      return;
    }
    ActionSchema::Level& level = schema_->levels()[depth];
    for (const ActionSchema::Candidate& c : level.candidates) {
      task_.limits_.work();
      const std::size_t before = open_count_;
      if (!test(c)) continue;
      slots_[depth] = c.object;
      arguments_[depth] = c.object;
      bool ok = true;
      for (ActionSchema::Check& check : level.checks)
        if (!test(schema_->grounded(check, slots_))) {
          ok = false;
          break;
        }
      if (ok) descend(depth + 1);
      open_count_ = before;
    }
  }

  void instance() {
    ++task_.tests_;
    if constexpr (Sensing) {
      if (open_count_ > 0) {
        for (std::size_t i = 0; i < open_count_; ++i)
          task_.evaluator_.open_fluents(open_[i], state_, task_.needs_);
        return;
      }
    }
    const OperatorId step = task_.action_id(number_, arguments_);
    const GroundAction& action = *task_.actions_[step];
    if ((unasked_ && action.asks) || settled(action)) steps_.push_back(step);
  }

  /// Whether the effects are the same for every way that sensed values may turn out.
  bool decided(const GroundAction& action) {
    bool all = true;
    for (const ConditionalEffect& c : action.effects) {
      const Truth t =
          c.condition == kTrue ? Truth::Yes : task_.evaluator_.evaluate(c.condition, state_);
      if (t == Truth::Open) {
        task_.evaluator_.open_fluents(c.condition, state_, task_.needs_);
        all = false;
      }
      if (t == Truth::Unresolved) return false;
      if (t != Truth::Yes) continue;
      for (const auto* list : {&c.deletions, &c.additions})
        for (const Change& change : *list) {
          const Index fluent = undecided(task_.layout_, change, state_);
          if (fluent == kNone) continue;
          task_.needs_.push_back(fluent);
          all = false;
        }
    }
    return all;
  }

  Task& task_;
  const Word* state_;
  std::vector<OperatorId>& steps_;
  Index* slots_;
  bool unasked_;
  Index number_ = 0;
  ActionSchema* schema_ = nullptr;
  std::vector<Index> arguments_;
  std::array<Formula, 64> open_;  ///< open formulas on the way down
  std::size_t open_count_ = 0;
};

template <bool Sensing>
void Task::expand_actions(const Word* state, std::vector<OperatorId>& steps, bool unasked) {
  Expansion<Sensing> expansion(*this, state, steps, unasked);
  for (Index s = 0; s < schemas_.size(); ++s) expansion.expand(s);
}

/// Whether it is known, so far as external functions go, which effects happen.
bool Task::resolved(const GroundAction& action, const Word* state) const {
  return !action.conditions_call ||
         std::none_of(action.effects.begin(), action.effects.end(),
                      [&](const ConditionalEffect& c) {
                        return evaluator_.evaluate(c.condition, state) == Truth::Unresolved;
                      });
}

bool Task::settled(const Word* state, OperatorId step) const {
  return actions_[step]->asks || resolved(*actions_[step], state);
}

bool Task::decide(const Word* state, OperatorId step, std::vector<OperatorId>& outcomes) {
  GroundAction& action = *actions_[step];
  const Truth truth = evaluator_.evaluate(action.precondition, state);
  needs_.clear();
  const bool possible =
      truth == Truth::Yes &&
      (layout_.sensing() ? Expansion<true>(*this, state, outcomes, false).settled(action)
                         : Expansion<false>(*this, state, outcomes, false).settled(action));
  if (truth == Truth::Open) evaluator_.open_fluents(action.precondition, state, needs_);
  if (possible) {
    ++action.granted;
    return true;
  }
  if (needs_.empty()) {
    ++action.refused;
    ++refused_;
  }
  std::sort(needs_.begin(), needs_.end());
  needs_.erase(std::unique(needs_.begin(), needs_.end()), needs_.end());
  for (const Index fluent : needs_)
    for (const Index value : this->outcomes(fluent, state))
      outcomes.push_back(outcome_id(fluent, value));
  return false;
}

void Task::expand(const Word* state, std::vector<OperatorId>& steps, bool unasked) {
  steps.clear();
  if (!layout_.sensing()) {
    expand_actions<false>(state, steps, unasked);
    return;
  }
  needs_.clear();
  expand_actions<true>(state, steps, unasked);
  if (evaluator_.evaluate(goal_, state) == Truth::Open)
    evaluator_.open_fluents(goal_, state, needs_);
  std::sort(needs_.begin(), needs_.end());
  needs_.erase(std::unique(needs_.begin(), needs_.end()), needs_.end());
  for (const Index fluent : needs_)
    for (const Index value : outcomes(fluent, state)) steps.push_back(outcome_id(fluent, value));
  if (pruned_branch_ && branching_ == Branching::OnNeed) return;
  for (const Index fluent : sensible_) {
    const Fluent& f = layout_.fluents()[fluent];
    const Word sensed = f.function ? kValueSensed : static_cast<Word>(AtomKnowledge::Whether);
    if (f.get(state) != sensed || std::binary_search(needs_.begin(), needs_.end(), fluent))
      continue;
    pruned_branch_ = true;
    if (branching_ == Branching::OnNeed) return;
    for (const Index value : outcomes(fluent, state)) steps.push_back(outcome_id(fluent, value));
  }
}

}  // namespace kaboum::plan
