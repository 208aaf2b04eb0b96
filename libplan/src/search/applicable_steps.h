#pragma once

#include <vector>

#include "search/relaxation.h"

namespace kaboum::plan {

/// The steps that are possible in a state of a task without sensing, out of those that the delete
/// relaxation reaches. Each is looked at only where one of the facts that it needs, the rarest,
/// holds.
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
  [[nodiscard]] bool applicable(const Step& s, const Word* state) const;

  const Task& task_;
  const FactTable& facts_;
  std::vector<Step> steps_;
  std::vector<BitTest> tests_;
  std::vector<Formula> rest_;
  std::vector<Index> watched_fluents_;
  std::vector<std::vector<Index>> watchers_;  ///< steps by fact
  std::vector<Index> always_;                 ///< steps that need no fact
  std::vector<Index> found_;
};

}  // namespace kaboum::plan
