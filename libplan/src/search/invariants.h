#pragma once

#include <tuple>
#include <vector>

#include "search/relaxation.h"

namespace kaboum::plan {

/// Groups of facts of which at most one holds in any reachable state.
///
/// Found as in Fast Downward's invariant synthesis ([helmert2009concise]): candidates "counted
/// facts that share a key object", e.g. {clear(x)} + {on(y, x) : y} + {holding(x)}, refined until
/// every action that adds a fact of a group also takes one away; here checked on ground actions.
class Invariants {
 public:
  Invariants(const Task& task, const Relaxation& relaxation, Limits& limits);

  /// Whether the two facts never hold together. Sound, not complete.
  [[nodiscard]] bool exclusive(FactId a, FactId b) const;
  [[nodiscard]] const std::vector<Index>& groups_of(FactId f) const { return groups_of_[f]; }
  [[nodiscard]] std::size_t groups() const { return groups_; }

 private:
  /// Facts of one symbol; the object at `key` names the group, the other places are counted.
  struct Part {
    bool function = false;
    Index symbol = 0;
    Index key = kNone;  ///< argument place; the number of arguments: the value; kNone: no key
    bool operator<(const Part& o) const {
      return std::tie(function, symbol, key) < std::tie(o.function, o.symbol, o.key);
    }
    bool operator==(const Part& o) const = default;
  };
  using Candidate = std::vector<Part>;
  struct Failure {
    bool too_heavy = false;
    Index op = 0;
    FactId add = 0;
    Index key = 0;
  };

  /// The group's key if the fact belongs to the candidate: an object, or their number if the part
  /// has no key; else kNone.
  [[nodiscard]] Index key_of(const Candidate& c, FactId f) const;
  [[nodiscard]] Index key_of(const Part& p, FactId f) const;
  [[nodiscard]] bool deletes(Index op, FactId f) const;
  [[nodiscard]] bool can_fire(const Candidate& c, const std::vector<FactId>& conditions) const;
  bool balanced(const Candidate& c, Failure& failure);

  const Task& task_;
  const Relaxation& relaxation_;
  Limits& limits_;
  std::vector<char> heavy_;  ///< keys of the candidate at hand that start with two facts or more
  std::vector<std::pair<Index, Index>> actions_;  ///< ranges of operators with the same step
  std::vector<Index> action_of_;                  ///< by operator
  std::vector<char> unconditional_;
  std::vector<std::vector<Index>> groups_of_;
  std::size_t groups_ = 0;
};

}  // namespace kaboum::plan
