#pragma once

#include <kaboum/plan/model.h>

#include <memory>
#include <unordered_map>
#include <vector>

#include "task/formula.h"
#include "task/knowledge.h"
#include "task/layout.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// One step of a search: a ground action, or an outcome of sensing that a branch supposes.
using Step = std::uint32_t;

/// Effects that happen together: the condition, then deletions, then additions, then sensing.
struct Conditional {
  Formula condition = kTrue;
  Index word = 0;  ///< the condition as a bit test, if mask is not 0
  Word mask = 0;
  Word value = 0;
  std::vector<Change> deletions;
  std::vector<Change> additions;
  std::vector<Change> sensing;
  /// Additions that are plain writes (no Kx groups or exclusions concerned), in their place.
  struct Write {
    Index word;
    Word mask;
    Word bits;
  };
  std::vector<Write> writes;
  std::vector<Change> plain;  ///< what the writes are made of: for analysis
};

struct GroundAction {
  Index schema = 0;
  std::vector<Index> arguments;
  std::int64_t cost = 1;
  Formula precondition = kTrue;
  std::vector<Conditional> effects;
};

/// A model made ready for search. Ground actions come into being when they are first reached.
class Task {
 public:
  /// @throws Stopped, as may all that grounds, when `limits` are reached.
  Task(const Model& model, Limits& limits);
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] FormulaPool& pool() { return pool_; }
  [[nodiscard]] const FormulaPool& pool() const { return pool_; }
  [[nodiscard]] const std::vector<Word>& initial() const { return initial_; }
  [[nodiscard]] Formula goal() const { return goal_; }

  /// Steps possible in a state: applicable actions in order of declaration and arguments; then, for
  /// sensed values that the goal or an otherwise applicable action needs decided, their outcomes;
  /// then, when branching anywhere, the outcomes of all other sensed values that something reads.
  void expand(const Word* state, std::vector<Step>& steps);

  /// To branch only on need keeps searches small but loses plans: which of two actions to take may
  /// depend on a value that is tested later. So a search on need that fails proves nothing if a
  /// branch was held back.
  enum class Branching { OnNeed, Anywhere };
  void branch(Branching b) { branching_ = b; }
  [[nodiscard]] bool held_back() const { return held_back_; }

  /// Makes the step. @return false if an outcome or observation contradicts what is known; the
  /// state is then meaningless and the step not possible.
  bool apply(Step step, Knowledge& state);

  [[nodiscard]] bool is_outcome(Step step) const { return (step & kOutcome) != 0; }
  [[nodiscard]] const GroundAction& action(Step step) const { return *actions_[step]; }
  struct Outcome {
    Index fluent = 0;
    Index value = 0;  ///< atom: 1 true, 0 false; term: position in the range
  };
  [[nodiscard]] Outcome outcome(Step step) const { return outcomes_[step & ~kOutcome]; }
  Step outcome_step(Index fluent, Index value);
  /// Every outcome of sensing this fluent in this state.
  [[nodiscard]] std::vector<Index> outcomes(Index fluent, const Word* state) const;
  [[nodiscard]] std::int64_t cost(Step step) const {
    return is_outcome(step) ? 0 : actions_[step]->cost;
  }
  [[nodiscard]] std::size_t action_count() const { return actions_.size(); }

  /// The ground action with these arguments (made if need be); its precondition is not looked at.
  Step action_step(Index schema, const std::vector<Index>& arguments);

  [[nodiscard]] std::uint64_t tests() const { return tests_; }  ///< action instances tested so far

  /// Calls `visit(arguments)` for the instances of a schema whose conjuncts `possible` does not
  /// rule out, tested as soon as their arguments are chosen.
  template <class Possible, class Visit>
  void instances(Index schema, const Possible& possible, const Visit& visit);

 private:
  static constexpr Step kOutcome = Step{1} << 31U;

  /// A conjunct of a precondition, tested when its last parameter has been chosen.
  struct Check {
    const Query* query = nullptr;
    std::vector<Index> slots;
    bool single = false;            ///< depends on the parameter chosen last only
    std::vector<Formula> grounded;  ///< by the slots' values; empty: too many to tabulate
  };
  struct Candidate {
    Index object = 0;
    Index word = 0;  ///< bit test that stands for the single-parameter conjuncts, if mask is not 0
    Word mask = 0;
    Word value = 0;
    Formula full = kTrue;  ///< those conjuncts
  };
  struct Level {
    std::vector<Candidate> candidates;
    std::vector<Check> checks;  ///< of several parameters, in the precondition's order
  };
  struct Schema {
    std::vector<Check> constant;  ///< conjuncts without parameters
    std::vector<Level> levels;
    std::vector<Step> steps;  ///< by the arguments' numbers; empty: use step_index
    std::unordered_map<std::string, Step> step_index;
  };
  struct Expansion;

  void prepare(Index schema);
  Formula grounded(Index schema, Check& check, const Index* slots);
  void ground_effects(const std::vector<Effect>& effects, Formula condition,
                      std::vector<Index>& slots, GroundAction& action);
  void add_change(const Update& update, const std::vector<Index>& slots, Conditional& conditional);
  [[nodiscard]] bool is_plain(const Change& change) const;
  /// A sensed fluent whose value decides what the change does; kNone: it does the same for all.
  [[nodiscard]] Index undecided(const Change& change, const Word* state) const;
  void make_initial();
  void find_sensible();
  template <bool Sensing>
  void expand_schema(Index schema, const Word* state, std::vector<Step>& steps,
                     std::vector<Index>& needs);

  const Model& model_;
  Limits& limits_;
  Layout layout_;
  FormulaPool pool_;
  std::vector<Word> initial_;
  Formula goal_ = kTrue;
  std::vector<Schema> schemas_;
  std::vector<std::unique_ptr<GroundAction>> actions_;
  std::vector<Outcome> outcomes_;
  std::map<std::pair<Index, Index>, Step> outcome_index_;
  std::vector<Index> slots_;
  std::vector<Index> needs_;
  std::vector<Index> sensible_;  ///< fluents whose sensed value some query reads, or Kx ties to one
  Branching branching_ = Branching::OnNeed;
  bool held_back_ = false;  ///< a branch was possible that nothing needed
  std::size_t grounded_updates_ = 0;
  std::uint64_t tests_ = 0;
};

template <class Possible, class Visit>
void Task::instances(Index schema, const Possible& possible, const Visit& visit) {
  Schema& s = schemas_[schema];
  std::vector<Index> slots(std::max<std::size_t>(model_.actions[schema].slots, 1), 0);
  for (Check& c : s.constant)
    if (!possible(grounded(schema, c, slots.data()))) return;
  const auto descend = [&](const auto& self, std::size_t depth) -> void {
    if (depth == s.levels.size()) {
      visit(std::vector<Index>(slots.begin(), slots.begin() + static_cast<std::ptrdiff_t>(depth)));
      return;
    }
    for (const Candidate& c : s.levels[depth].candidates) {
      limits_.work();
      if (!possible(c.full)) continue;
      slots[depth] = c.object;
      bool ok = true;
      for (Check& check : s.levels[depth].checks)
        if (!possible(grounded(schema, check, slots.data()))) {
          ok = false;
          break;
        }
      if (ok) self(self, depth + 1);
    }
  };
  descend(descend, 0);
}

}  // namespace kaboum::plan
