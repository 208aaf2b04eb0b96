#pragma once

#include <kaboum/plan/solve.h>

#include <unordered_map>
#include <vector>

#include "search/assumptions.h"
#include "search/regression.h"
#include "search/search.h"

namespace kaboum::plan {

/// And-or planning by weak plans, repaired until every outcome is covered.
///
/// A search that may choose outcomes finds a weak plan. Going back along it, each branch's other
/// outcomes are planned for in turn; then the step joins the policy with its regressed condition.
/// Later searches stop at any state that satisfies such a condition, so equal sub-plans are shared.
/// A node is entered only after its successors: the graph cannot have cycles. A branch with an
/// outcome that has no plan is forbidden in that state, and the search repeated. If that fails and
/// a branch that nothing needed was left out, all states are looked at (exhaustive.h): only then is
/// it proved that there is no plan. The same is tried, on a budget, where failures are many:
/// repairs can take exponentially many searches among few states. Outcomes that are assumed not to
/// happen need no plan. docs/planning/search.md.
class ContingentPlanner final : private Target {
 public:
  using SearchFunction = SearchResult (*)(const SearchInput&);

  ContingentPlanner(Task& task, SearchFunction search, const Assumptions& assumptions,
                    Limits& limits, Statistics& statistics);

  /// Plans from the task's initial state. On success `plan()` is the result.
  Outcome run();
  [[nodiscard]] Plan plan() const;

 private:
  static constexpr Index kGoal = 0;  ///< the policy entry that stands for being done

  struct Entry {
    Formula condition = kTrue;
    OperatorId step = 0;  ///< an action; of a branch, its first outcome
    bool branch = false;
    Index next = kGoal;
    std::vector<std::pair<OperatorId, Index>> cases;  ///< of a branch
    std::vector<Plan::Call> calls;                    ///< of an action
    Index same_as = kGoal;  ///< the first entry with the same sub-plan, itself if none
  };

  using State = std::vector<Word>;
  struct StateHash {
    std::size_t operator()(const State& s) const {
      return Knowledge::hash_of(s.data(), static_cast<Index>(s.size()));
    }
  };
  /// Why something failed: depths on the stack of open problems that it ran into. Empty: for good.
  using ConflictSet = std::vector<Index>;

  // Target
  bool reached(const Word* state) override;
  bool allowed(const Word* state, OperatorId outcome) override;
  bool expects(const Word* state, OperatorId outcome) override {
    return assumptions_.expects(state, outcome);
  }

  [[nodiscard]] Index match(const Word* state) const;
  Outcome solve(const State& start, Index& entry, ConflictSet& conflict);
  Outcome exhaust(std::size_t most_states);
  bool decided_otherwise();
  Index branch(const State& at, std::vector<std::pair<OperatorId, Index>> cases);
  void require_assumption(const State& at, OperatorId outcome, std::vector<Formula>& conditions);
  Outcome cover(const State& at, OperatorId step, Index next, Index& entry, ConflictSet& conflict);
  Index act(const State& at, OperatorId step, Index next);
  Index add(Entry entry);
  void close_problem(Index depth);

  Task& task_;
  SearchFunction search_;
  const Assumptions& assumptions_;
  Limits& limits_;
  Statistics& statistics_;
  Heuristics heuristics_;
  Regression regression_;
  std::vector<Entry> entries_;
  std::unordered_map<std::uint64_t, std::vector<Index>> entry_index_;
  std::unordered_map<State, std::map<Index, ConflictSet>, StateHash>
      forbidden_;  ///< by state, then fluent
  std::unordered_map<State, ConflictSet, StateHash> dead_;
  std::unordered_map<State, Index, StateHash> open_problems_;  ///< states being solved: depth
  Index root_ = kGoal;
  std::uint64_t failures_ = 0;       ///< branches that were forbidden
  std::uint64_t next_attempt_ = 50;  ///< failures at which to look at all states
  std::optional<Outcome> verdict_;   ///< what that found
};

}  // namespace kaboum::plan
