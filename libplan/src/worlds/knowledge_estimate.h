#pragma once

#include <map>
#include <vector>

#include "task/solve_limits.h"
#include "worlds/alternatives.h"
#include "worlds/belief_space.h"
#include "worlds/relaxed_rules.h"

namespace kaboum::plan::worlds {

/// How far a belief is from the next of its goals, what has to be found out included: a relaxed
/// plan for one of its worlds, the first of a sample. What an operator needs must hold in all
/// worlds of the sample but those that something sensed has told apart from the first.
/// docs/planning/knowledge-states.md, "Possible worlds".
class KnowledgeEstimate {
 public:
  static constexpr int kDead = RelaxedRules::kUnreached;

  /// @throws LimitExceeded
  KnowledgeEstimate(const BeliefSpace& space, Limits& limits);

  /// kDead: the belief has no plan.
  int operator()(const Word* belief);

 private:
  static constexpr Index kSample = 8;       ///< worlds of each component
  static constexpr Index kPlans = 3;        ///< worlds that plans are looked for
  static constexpr Index kMostValues = 32;  ///< of a term that tells worlds apart by its value
  static constexpr int kGoal = 10'000;      ///< a goal that does not hold counts more than any plan

  using Cost = RelaxedRules::Cost;

  [[nodiscard]] bool hidden(Index variable) const {
    return space_.task().variables[variable].hidden;
  }
  [[nodiscard]] Index in_world(const Literal& l, Index world) const {
    return base_[l.first] + l.second * (hidden(l.first) ? kSample : 1) +
           (hidden(l.first) ? world : 0);
  }
  [[nodiscard]] Index ruled_out(Index component, Index world) const {
    return ruled_out_ + component * kSample + world;
  }
  Index known(const Literal& l);
  std::vector<Index> known(const std::vector<Literal>& all);
  Index sensed(Index variable);
  void add_operator(const Operator& o);
  void add_change(const Step& s, Index step);
  void add_goal(const Condition& goal);
  void sample(const Word* belief, Index plan);

  const BeliefSpace& space_;
  RelaxedRules rules_;
  std::vector<Index> base_;  ///< by variable
  Index ruled_out_ = 0;
  std::map<Literal, Index> known_;
  std::map<Index, Index> sensed_;
  std::vector<std::pair<const Condition*, Index>> goals_;  ///< and propositions
  std::vector<Index> holding_;                             ///< of one computation
};

}  // namespace kaboum::plan::worlds
