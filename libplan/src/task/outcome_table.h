#pragma once

#include <map>
#include <utility>
#include <vector>

#include "task/ground_action.h"

namespace kaboum::plan {

/// Ways in which sensing may turn out, as steps of a search: numbers beside those of actions.
class OutcomeTable {
 public:
  struct Outcome {
    Index fluent = 0;
    Index value = 0;  ///< atom: 1 true, 0 false; term: position in the range
  };
  /// Steps from this number on are outcomes.
  static constexpr OperatorId kFirst = OperatorId{1} << 31U;

  static bool contains(OperatorId step) { return (step & kFirst) != 0; }
  [[nodiscard]] Outcome operator[](OperatorId step) const { return outcomes_[step & ~kFirst]; }
  /// The step; a new number, if it is new.
  OperatorId id(Index fluent, Index value) {
    const auto [it, fresh] = index_.emplace(std::pair(fluent, value),
                                            static_cast<OperatorId>(outcomes_.size()) | kFirst);
    if (fresh) outcomes_.push_back({fluent, value});
    return it->second;
  }

 private:
  std::vector<Outcome> outcomes_;
  std::map<std::pair<Index, Index>, OperatorId> index_;
};

}  // namespace kaboum::plan
