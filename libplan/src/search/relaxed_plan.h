#pragma once

#include <vector>

#include "search/relaxation.h"

namespace kaboum::plan {

/// The relaxed-plan heuristic (Hoffmann and Nebel 2001, [hoffmann2001ff]): the cost of a plan of
/// the delete relaxation, put together from each fact's cheapest supporter under the additive
/// heuristic. Not admissible. Actions cost at least one here: a free step is still a step away from
/// the goal. What external functions say is taken for granted where they were not asked; an action
/// that they have refused costs more from then on.
class RelaxedPlan {
 public:
  explicit RelaxedPlan(Task& task, Relaxation& relaxation);

  /// Estimate from this state; kDeadEnd if the goal is out of reach even relaxed.
  static constexpr std::uint64_t kDeadEnd = ~std::uint64_t{0};
  std::uint64_t evaluate(const Word* state);

  /// Nodes of the graph that an evaluation walks.
  [[nodiscard]] std::size_t size() const { return parents_.size(); }

  /// Steps of the last relaxed plan, ascending: those applicable now are the preferred ones.
  [[nodiscard]] const std::vector<OperatorId>& steps() const { return steps_; }

 private:
  /// Of an action that external functions refused so far: as often as they are likely to be asked
  /// until they grant it.
  [[nodiscard]] std::uint64_t cost_of(OperatorId step) const;
  void settle(Index node, std::uint64_t cost, Index supporter);

  Task& task_;
  Relaxation& relaxation_;
  Index goal_ = 0;
  std::vector<std::vector<Index>> parents_;   ///< node: nodes it is a child of
  std::vector<std::vector<Index>> achieves_;  ///< operator's node: its operator (0 or 1 entries)
  std::vector<std::uint64_t> cost_;
  std::vector<Index> missing_;    ///< All nodes: children not yet reached
  std::vector<Index> supporter_;  ///< Fact: operator; Any: child
  std::vector<OperatorId> steps_;
  std::vector<std::pair<std::uint64_t, Index>> queue_;
};

}  // namespace kaboum::plan
