#pragma once

#include <cstdint>
#include <vector>

#include "search/radix_queue.h"
#include "search/relaxation.h"

namespace kaboum::plan {

/// The relaxed-plan heuristic (Hoffmann and Nebel 2001, [hoffmann2001ff]): the steps of a plan of
/// the delete relaxation, put together from each fact's cheapest supporter under the additive
/// heuristic. Not admissible. Every action counts as one, whatever it costs: the goal is near where
/// few steps are left. What external functions say is taken for granted where they were not asked;
/// an action that they have refused counts more from then on.
class RelaxedPlan {
 public:
  /// @param goal  what holds of a reachable state where the task's goal does.
  RelaxedPlan(Task& task, Relaxation& relaxation, Formula goal);

  /// Estimate from this state; kDeadEnd if the goal is out of reach even relaxed.
  static constexpr std::uint64_t kDeadEnd = ~std::uint64_t{0};
  std::uint64_t evaluate(const Word* state);

  /// Edges of the graph that an evaluation walks.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Those that the last evaluation has walked: it ends where the goal is reached.
  [[nodiscard]] std::size_t walked() const { return walked_; }

  /// Steps of the last relaxed plan, ascending: those applicable now are the preferred ones.
  [[nodiscard]] const std::vector<OperatorId>& steps() const { return steps_; }
  /// The same in an order in which the relaxed plan may make them: by what their conditions cost.
  [[nodiscard]] std::vector<OperatorId> steps_in_order() const;

 private:
  using Cost = std::uint32_t;
  /// A conjunction, or with kValue a value: a fact or a disjunction.
  using Ref = std::uint32_t;
  static constexpr Ref kValue = Ref{1} << 31U;

  /// Lists of numbers, one after the other.
  struct Lists {
    std::vector<Index> first = {0};
    std::vector<Index> items;

    void add(const std::vector<Index>& list) {
      items.insert(items.end(), list.begin(), list.end());
      first.push_back(static_cast<Index>(items.size()));
    }
    [[nodiscard]] const Index* begin(Index i) const { return items.data() + first[i]; }
    [[nodiscard]] const Index* end(Index i) const { return items.data() + first[i + 1]; }
    [[nodiscard]] std::size_t size(Index i) const { return first[i + 1] - first[i]; }
  };
  /// A conjunction: of what it waits for, and what it costs so far.
  struct Counter {
    Index missing;
    Cost sum;
  };

  class Builder;

  /// Of an action that external functions refused so far: as often as they are likely to be asked
  /// until they grant it.
  [[nodiscard]] Cost cost_of(OperatorId step) const;
  void settle(Index value, Cost cost, Ref supporter);
  void count(Index conjunction, Cost cost);
  void complete();
  void explore(const Word* state);
  std::uint64_t extract();

  Task& task_;
  std::size_t size_ = 0;
  Ref goal_ = 0;
  // Values.
  std::vector<Index> fluents_;     ///< those with facts that matter
  std::vector<Index> first_fact_;  ///< by these: into value_of_
  std::vector<Word> contents_;     ///< by these
  std::vector<Index> value_of_;    ///< by fluent and content; kNone: it does not matter
  Lists needed_by_;                ///< conjunctions, by value
  Lists option_of_;                ///< disjunctions, by value
  // Conjunctions. Those of operators are the precondition and the condition of one effect.
  std::vector<OperatorId> step_;  ///< kNoOperator: of no operator
  Lists children_;                ///< Ref
  Lists part_of_;                 ///< conjunctions
  Lists brings_;                  ///< values
  std::vector<Index> empty_;      ///< without children
  std::vector<Index> asking_;     ///< of actions whose costs change

  // Of the state at hand.
  std::vector<Counter> at_start_, counters_;
  std::vector<Cost> cost_;       ///< by value
  std::vector<Ref> supporter_;   ///< by value
  std::vector<Index> complete_;  ///< conjunctions that hold, whose consequences are not drawn
  std::vector<char> seen_value_, seen_conjunction_;
  std::vector<Ref> todo_, seen_;
  bool reached_ = false;
  std::size_t walked_ = 0;
  RadixQueue queue_;
  std::vector<OperatorId> steps_;
  std::vector<std::pair<Cost, OperatorId>> used_;  ///< costs and steps, of effects
};

}  // namespace kaboum::plan
