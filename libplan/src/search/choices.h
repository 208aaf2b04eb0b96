#pragma once

#include <kaboum/plan/plan.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace kaboum::plan {

/// A call that chooses among several things, as the failure of a search shows it.
struct ChoosingCall {
  unsigned choice = 0;       ///< that was made
  unsigned most = 0;         ///< among how many
  std::uint64_t blamed = 0;  ///< answers that were no new value of a handle, and rest on it
  bool needed = false;       ///< a call that all plans need had no value for that
};

/// By the calls' texts, "fetch(robot1, o1, home)".
using ChoosingCalls = std::map<std::string, ChoosingCall>;

/// Conflict-directed search through the choices of calls [williams2007conflict].
///
/// A search that fails with some choices gives a conflict: what the calls that its failures rest on
/// had chosen. No choices that hold a conflict are tried again. Those calls are changed next, all
/// at once or one by one, in turns; calls that nothing failed by keep what they chose. Where a call
/// failed that all plans need, what that rests on is changed first.
class ChoiceSearch {
 public:
  /// Where a search failed with `choices`. Without any call that is blamed all are.
  void add_failure(const Choices& choices, const ChoosingCalls& calls);

  /// What is to be tried now; nullopt: all that may matter was tried.
  std::optional<Choices> next();

  /// Conflicts that were learnt.
  [[nodiscard]] std::size_t conflicts() const { return conflicts_.size(); }

  /// About as much as is kept of what was learnt and of what may be tried.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  /// What may be tried. First what changes what is needed, then those of searches by which few
  /// calls were blamed, then those that change what was blamed most, then the oldest.
  struct Candidate {
    bool not_needed = false;
    std::size_t blamed_calls = 0;
    std::uint64_t spared = 0;  ///< blames of other calls
    std::size_t order = 0;
    Choices choices;
    [[nodiscard]] bool operator<(const Candidate& o) const {
      return std::tie(not_needed, blamed_calls, spared, order) <
             std::tie(o.not_needed, o.blamed_calls, o.spared, o.order);
    }
  };
  using Candidates = std::set<Candidate>;

  [[nodiscard]] bool holds_conflict(const Choices& choices) const;
  void drop_conflicts(Candidates& from) const;

  Candidates together_, single_;
  std::set<Choices> seen_ = {{}};
  std::vector<Choices> conflicts_;  ///< with the calls that chose what is nearest, as 0
  bool one_by_one_ = true;          ///< whose turn it was
  std::size_t bytes_ = 0;
};

}  // namespace kaboum::plan
