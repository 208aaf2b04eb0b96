#pragma once

#include <map>
#include <string>

#include "task/task.h"

namespace kaboum::plan {

/// How sensing is assumed to turn out [gaschler2016, §3.3.1].
class Assumptions {
 public:
  /// @param stated  values by atom or term, as in SolveOptions.
  /// @throws Error{InvalidArgument} for names that the model does not have.
  Assumptions(Task& task, const std::map<std::string, std::string>& stated);

  /// Whether an outcome is looked at in a state: nothing is assumed of its fluent; or it is what is
  /// assumed; or what is assumed cannot be, as is known there.
  [[nodiscard]] bool expects(const Word* state, OperatorId outcome) const;

 private:
  Task& task_;
  std::map<Index, OperatorId> outcomes_;  ///< that are assumed, by fluent
};

}  // namespace kaboum::plan
