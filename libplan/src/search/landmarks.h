#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "search/event_bound.h"
#include "search/invariants.h"
#include "search/relaxation.h"

namespace kaboum::plan {

/// Admissible, domain-independent estimate from landmark events.
///
/// An event is an occurrence of some action that every plan from the state must contain: the first
/// time a landmark becomes true, or the last time a goal does. Backward chaining finds events and
/// orders them: a precondition comes before; what excludes a goal comes before the goal's last
/// achievement. When the same actions must happen both before and after something else (a cycle
/// among landmarks, [buechner2021cyclic]) the orders make two events of them, which cost twice. The
/// estimate is the larger of
///   - the cost of events that pairwise cannot be one and the same occurrence, and
///   - uniform cost partitioning over all events ([karpas2009landmarks]).
/// Proof of admissibility: docs/planning/search.md.
class LandmarkHeuristic {
 public:
  /// @param goal  what holds of a reachable state where the task's goal does.
  LandmarkHeuristic(Task& task, const Relaxation& relaxation, const Invariants& invariants,
                    Formula goal);

  /// Lower bound on the cost to the goal; nullopt: the goal cannot be reached.
  std::optional<std::uint64_t> evaluate(const Word* state);

  /// Steps of which none can be another one, in every plan: cheaper, and costs do not count.
  std::optional<std::uint64_t> count(const Word* state);

  /// Steps that may be one of the events of the last evaluation.
  [[nodiscard]] ActionSet achievers() const;
  [[nodiscard]] bool is_in(OperatorId step, const ActionSet& set) const {
    const Index n = number_of_[step];
    return n != kNone && ((set[n / 64] >> (n % 64)) & 1U) != 0;
  }

  /// Events of the last evaluation, whose time grows with their cube.
  [[nodiscard]] std::size_t events() const { return events_.size(); }

  /// By event of the last evaluation: facts of which one has yet to come true for the first time.
  [[nodiscard]] std::vector<std::vector<FactId>> landmarks() const;

 private:
  /// Achievers of a fact that can only be its first achievers while all of `guards` hold.
  struct Bucket {
    std::vector<FactId> guards;
    ActionSet actions;
    std::vector<FactId> conditions;  ///< common to all
    std::vector<std::vector<FactId>>
        options;  ///< every achiever has a condition among each of these
  };
  struct FactInfo {
    bool ready = false;
    std::vector<Bucket> buckets;
    std::vector<FactId> conditions;  ///< common to all achievers
    std::vector<Index> excludes;     ///< goals that exclude this fact
  };
  bool find_events(const Word* state);
  FactInfo& info(FactId f);
  std::vector<FactId> common_conditions(FactId f);
  Index first_event(std::vector<FactId> facts, const Word* state);
  Index last_event(Index goal);
  void order(Index before, Index after, bool strict);
  bool relate(Index event, const Word* state);

  Task& task_;
  const Relaxation& relaxation_;
  const Invariants& invariants_;
  std::size_t words_ = 0;            ///< of a set of actions
  std::vector<std::int64_t> costs_;  ///< by action number
  std::vector<Index> number_of_;     ///< by step
  std::map<OperatorId, Index> number_of_outcome_;
  std::vector<std::vector<Index>> achievers_;  ///< by fact
  std::vector<std::vector<FactId>> common_;    ///< by fact, once common_ready_
  std::vector<char> common_ready_;
  std::vector<FactInfo> infos_;
  std::vector<char> opaque_;  ///< by fact
  std::vector<FactId> goals_;
  std::vector<std::vector<Index>> goals_in_group_;

  // of the state at hand
  std::vector<LandmarkEvent> events_;
  std::map<std::vector<FactId>, Index> first_;
  std::vector<Index> last_;
  std::vector<EventOrder> orders_;
  bool dead_ = false;
};

}  // namespace kaboum::plan
