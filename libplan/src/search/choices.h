#pragma once

#include <kaboum/plan/plan.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace kaboum::plan {

/// A call that chooses among several things, as the failure of a search shows it.
struct ChoosingCall {
  unsigned choice = 0;       ///< that was made
  unsigned most = 0;         ///< among how many
  std::uint64_t blamed = 0;  ///< answers that were no new value of a handle, and rest on it
};

/// By the calls' texts, "fetch(robot1, o1, home)".
using ChoosingCalls = std::map<std::string, ChoosingCall>;

/// Conflict-directed search through the choices of calls [williams2007conflict].
///
/// A search that fails with some choices gives a conflict: what the calls that its failures rest on
/// had chosen. No choices that hold a conflict are tried again. Those calls are changed next, all
/// at once or one by one, in turns; calls that nothing failed by keep what they chose.
class ChoiceSearch {
 public:
  /// Where a search failed with `choices`. Without any call that is blamed all are.
  void add_failure(const Choices& choices, const ChoosingCalls& calls);

  /// What is to be tried now; nullopt: all that may matter was tried.
  std::optional<Choices> next();

  /// Conflicts that were learnt.
  [[nodiscard]] std::size_t conflicts() const { return conflicts_.size(); }

 private:
  /// What may be tried. First those of searches by which few calls were blamed, then those that
  /// change what was blamed most, then the oldest.
  struct Candidate {
    std::size_t blamed_calls = 0;
    std::uint64_t spared = 0;  ///< blames of other calls
    std::size_t order = 0;
    Choices choices;
    [[nodiscard]] auto operator<=>(const Candidate&) const = default;
  };
  using Candidates = std::set<Candidate>;

  [[nodiscard]] bool holds_conflict(const Choices& choices) const;
  std::optional<Choices> take(Candidates& from);

  Candidates together_, single_;
  std::set<Choices> seen_ = {{}};
  std::vector<Choices> conflicts_;  ///< with the calls that chose what is nearest, as 0
  bool one_by_one_ = false;         ///< whose turn it is
};

}  // namespace kaboum::plan
