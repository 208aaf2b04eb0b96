#pragma once

#include <vector>

#include "search/relaxation.h"

namespace kaboum::plan {

/// The steps that are possible in a state of a task without sensing, out of those that the delete
/// relaxation reaches. They are the leaves of a tree, by the facts that they need: no step is
/// looked at, unless the facts on the way to it hold.
class ApplicableSteps {
 public:
  /// @pre the arguments outlive it.
  ApplicableSteps(const Task& task, const Relaxation& relaxation);

  /// In order of declaration and arguments: those of `Task::expand_unasked`.
  void find(const Word* state, std::vector<OperatorId>& steps);

 private:
  struct Step {
    OperatorId step = kNoOperator;
    Index first_test = 0, last_test = 0;  ///< what one field of the state has to be
    Index first_rest = 0, last_rest = 0;  ///< what else has to hold
  };
  /// Of the tree, whose nodes are in the order in which they are visited.
  struct Node {
    BitTest test;
    Index first = 0, last = 0;  ///< its steps, in `order_`
    Index skip = 0;             ///< the next node that is not below it
  };
  [[nodiscard]] bool applicable(const Step& s, const Word* state) const;
  [[nodiscard]] bool distinguishes(FactId f) const;
  void grow(const std::vector<std::vector<FactId>>& paths, Index begin, Index end,
            std::size_t depth, const BitTest& test);

  const Task& task_;
  const FactTable& facts_;
  std::vector<Step> steps_;
  std::vector<BitTest> tests_;
  std::vector<Formula> rest_;
  std::vector<Index> order_;  ///< of the steps in the tree
  std::vector<Node> nodes_;
  std::vector<Index> found_;
};

}  // namespace kaboum::plan
