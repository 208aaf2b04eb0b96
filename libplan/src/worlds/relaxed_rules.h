#pragma once

#include <cstdint>
#include <vector>

#include "worlds/world_task.h"

namespace kaboum::plan::worlds {

/// Rules by which propositions come to hold and never cease to: steps, which are counted, and what
/// follows for free.
class RelaxedRules {
 public:
  static constexpr int kUnreached = 1'000'000'000;

  enum class Cost : std::uint8_t {
    Step,    ///< one more than all that it needs
    Sum,     ///< of what it needs
    Highest  ///< of what it needs: for much that the same steps bring about
  };

  /// New propositions: the number of the first of `count`.
  Index propositions(Index count);
  /// @pre no plan was asked for yet. A rule without needs always applies.
  void add(std::vector<Index> needs, const std::vector<Index>& adds, Cost cost);

  /// Of what it holds before a plan is first asked for; about as much again is held then.
  [[nodiscard]] std::size_t bytes() const;

  /// How many steps a relaxed plan [hoffmann2001ff] has that brings a proposition about: of each
  /// that it needs the cheapest rule, costs added up. kUnreached: there is none.
  int plan(const std::vector<Index>& holding, Index wanted);

 private:
  /// Sums of costs may grow exponentially; beyond this they are all the same.
  static constexpr int kMostCost = 20'000;

  /// Lists of numbers, one after the other.
  struct Lists {
    std::vector<Index> begins = {0};
    std::vector<Index> elements;
    void append(const std::vector<Index>& list);
  };

  void prepare();
  void set_cost(Index proposition, int cost, Index by);
  bool reach(Index wanted);
  void apply(Index rule);
  int count_steps(Index wanted);

  Index propositions_ = 0;
  std::vector<Cost> kinds_;  ///< of rules
  Lists needs_, adds_;       ///< by rule
  Lists needed_by_;          ///< by proposition
  std::vector<Index> need_counts_;
  std::vector<int> own_costs_;
  // Of one computation:
  std::vector<int> costs_, rule_costs_;
  std::vector<Index> missing_, supporters_;
  std::vector<std::vector<Index>> buckets_;
  std::vector<char> marked_, counted_;
};

}  // namespace kaboum::plan::worlds
