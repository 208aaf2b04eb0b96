#pragma once

#include <vector>

#include "search/search.h"
#include "search/state_store.h"

namespace kaboum::plan {

/// All states that actions and outcomes lead to, branching anywhere, and which of them have a plan:
/// the least fixed point of "a target; or an action leads to such a state; or all outcomes of one
/// sensed value do". Linear in the steps between the states, so it decides, where the guided search
/// on need may only give up, at the price of looking at every state.
class Exhaustive {
 public:
  explicit Exhaustive(const SearchInput& in);

  /// Looks at everything. Limit if the limits, or so many states, were reached first.
  Outcome run(std::size_t most_states);

  /// What to do in a state of the plan: perform an action, or branch.
  struct Decision {
    std::vector<Word> state;
    std::vector<std::pair<OperatorId, Index>> cases;  ///< step, and the decision it leads to
  };
  /// The plan, each decision after those it leads to; a target has no cases; the start comes last.
  [[nodiscard]] std::vector<Decision> plan() const;

 private:
  struct Edge {
    Index source = 0;
    Index first = 0;    ///< into targets_ and steps_
    Index count = 0;    ///< of an action 1
    Index missing = 0;  ///< targets that are not yet known to have a plan
  };

  bool explore(std::size_t most_states);
  void expand(Index state);

  SearchInput in_;
  StateStore store_;
  std::vector<Edge> edges_;
  std::vector<Index> targets_;
  std::vector<OperatorId> steps_;
  std::vector<Index> solved_;    ///< states, in the order in which they were found to have a plan
  std::vector<Index> decision_;  ///< by state: its edge; kNone: a target, or no plan
  std::vector<char> has_plan_;
};

}  // namespace kaboum::plan
