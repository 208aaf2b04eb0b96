#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "search/evaluator.h"
#include "search/search.h"

namespace kaboum::plan {

/// Work, in nanoseconds, about: of a step that is made, of an edge of a relaxed plan's graph.
inline constexpr std::uint64_t kPerStep = 700, kPerEdge = 3;

/// A search that can pause.
class Engine {
 public:
  virtual ~Engine() = default;

  /// Goes on, until so much work has led no nearer to the goal: about a nanosecond each, but
  /// counted, not measured, so that equal searches pause at equal states.
  /// @param besides  bytes that others hold, for the limit of memory
  /// @return what it has found, if it ends within that; Outcome::Limit and no reason in the limits
  /// where it alone needs too much memory.
  virtual std::optional<SearchResult> advance(std::uint64_t work, std::size_t besides) = 0;
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

/// Greedy best-first search (greedy_search.cpp).
/// @param evaluators     which take turns; the first also tells when to look ahead, and where
/// @param most_expanded  states, before it gives up
std::unique_ptr<Engine> greedy_engine(const SearchInput& in,
                                      std::span<EvaluatorMaker* const> evaluators,
                                      std::uint64_t most_expanded);

/// Best-first width search (width_search.cpp).
/// @pre without sensing and external functions.
std::unique_ptr<Engine> width_engine(const SearchInput& in);

/// Both, which take turns that become longer, estimates first.
/// @param first  work of the first turns
/// @pre without sensing and external functions.
SearchResult take_turns(const SearchInput& in, std::uint64_t first);

}  // namespace kaboum::plan
