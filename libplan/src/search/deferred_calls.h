#pragma once

#include <vector>

#include "search/search.h"

namespace kaboum::plan {

/// Calls of external functions that are put off until a plan is found: a search takes for granted
/// that all of them have a value, and only those of its plan are made.
///
/// Such a search is one of other states. What a handle's term contains is left out of them (it is
/// what calls return), so states that differ in nothing else are one. Every plan is a plan there,
/// as long as nothing but calls reads handles. So the first plan of a search for fewest steps has
/// the fewest steps if its calls have values, and there is no plan where there is none there.
class DeferredCalls {
 public:
  static constexpr bool kAsked = false;
  /// After so many the search ends: where most calls have no value, there are many more of these
  /// states than of real ones.
  static constexpr std::size_t kMostStates = 1'000'000;

  /// @param in  must outlive this.
  explicit DeferredCalls(const SearchInput& in);

  /// Whether that can be done: no sensing, no calls in the goal, functions that read the state.
  [[nodiscard]] bool possible() const { return possible_; }
  /// The search's input, from a start without handles.
  [[nodiscard]] SearchInput input() const;

  // Of such a state; @pre possible().
  void expand(const Word* state, std::vector<OperatorId>& steps) const {
    in_.task.expand_unasked(state, steps);
  }
  static bool is_possible(const Word*, OperatorId, std::vector<OperatorId>&) { return true; }
  /// @return false: what the step does cannot be told, and nor can what the search finds be.
  bool apply(OperatorId step, Knowledge& state) {
    const bool told = in_.task.suppose(step, state);
    all_told_ = all_told_ && told;
    return told;
  }

  /// Whether what a search from `input` has found is so: steps whose calls have values, one after
  /// the other from the real start on; that there is no plan; that a limit is reached.
  [[nodiscard]] bool confirms(const SearchResult& found) const;

 private:
  [[nodiscard]] bool reads_handles() const;

  const SearchInput& in_;
  std::vector<Word> start_;
  bool possible_ = false, all_told_ = true;
};

}  // namespace kaboum::plan
