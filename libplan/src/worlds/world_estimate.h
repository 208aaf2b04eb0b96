#pragma once

#include <unordered_map>
#include <vector>

#include "worlds/belief_space.h"

namespace kaboum::plan::worlds {

/// How far a belief's worlds are from the goal: the largest relaxed plan [hoffmann2001ff] of some
/// of them, each taken as if it were known.
class WorldEstimate {
 public:
  static constexpr int kDead = 1'000'000'000;

  explicit WorldEstimate(const BeliefSpace& space);

  /// kDead: a world of the belief has no plan even if it were known, so the belief has none.
  int operator()(const Word* belief);

  [[nodiscard]] std::size_t bytes() const { return known_.size() * 48; }

 private:
  static constexpr std::size_t kSamples = 8;

  /// An operator's steps under one condition.
  struct Unary {
    std::vector<Index> needs, adds;
    Index group = 0;  ///< operator
  };

  [[nodiscard]] Index fact(Index variable, Index value) const { return base_[variable] + value; }
  void add_unary(const Operator& o, Index number);
  [[nodiscard]] std::vector<std::vector<Index>> needs(
      const std::vector<const Condition*>& all) const;
  int relaxed_plan(const std::vector<Index>& state);

  const BeliefSpace& space_;
  bool observes_ = false;  ///< an observation may rule worlds out: none of them is dead for certain
  std::vector<Index> base_;
  std::vector<Unary> unary_;
  std::vector<std::vector<Index>> needed_by_;  ///< fact: unary operators
  std::vector<Index> without_needs_;
  std::vector<std::vector<Index>> goals_;  ///< alternatives
  std::unordered_map<std::uint64_t, int> known_;
  // Of one computation:
  std::vector<int> cost_, unary_cost_;
  std::vector<Index> missing_, supporter_;
  std::vector<std::vector<Index>> buckets_;
  std::vector<char> marked_, chosen_;
};

}  // namespace kaboum::plan::worlds
