// Greedy search as users know it: by estimates, and by novelty where these lead nowhere.
#include <utility>

#include "search/engine.h"

namespace kaboum::plan {
namespace {

/// Searches where external functions refuse steps: what the first one has learned of that makes the
/// plans of later ones shorter, and most of what they ask has been asked before.
constexpr int kRounds = 3;

constexpr std::uint64_t kUnlimited = std::uint64_t{1} << 62U;

/// Some seconds without progress: where a task is solved at all by one search, there mostly are
/// fewer.
constexpr std::uint64_t kFirstTurn = 2'500'000'000;

SearchResult by_estimates(const SearchInput& in) {
  SearchResult best;
  std::uint64_t most_expanded = kUnlimited;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t refused = in.task.refused(), expanded = in.statistics.expanded;
    SearchResult found =
        greedy_engine(in, kGreedyEvaluators, most_expanded)->advance(kUnlimited, 0).value();
    if (round == 0 || (found.outcome == Outcome::Solved && found.steps.size() < best.steps.size()))
      best = std::move(found);
    if (best.outcome != Outcome::Solved || in.task.refused() == refused) break;
    most_expanded = in.statistics.expanded - expanded;
  }
  return best;
}

}  // namespace

SearchResult take_turns(const SearchInput& in, std::uint64_t first) {
  const auto estimates = greedy_engine(in, kGreedyEvaluators, kUnlimited);
  std::unique_ptr<Engine> novelty;
  for (std::uint64_t work = first;; work *= 2) {
    if (auto found = estimates->advance(work, novelty ? novelty->bytes() : 0)) return *found;
    if (!novelty) novelty = width_engine(in);
    auto found = novelty->advance(work, estimates->bytes());
    if (!found) continue;
    if (found->outcome != Outcome::Limit || !in.limits.reason().empty()) return *found;
    novelty.reset();  // there is not memory enough for both
    return estimates->advance(kUnlimited, 0).value();
  }
}

SearchResult greedy_best_first(const SearchInput& in) {
  if (in.target.reached(in.start.data())) return {Outcome::Solved, {}};
  const bool calls = !in.task.model().external_functions.empty();
  return calls || in.task.layout().sensing() ? by_estimates(in) : take_turns(in, kFirstTurn);
}

}  // namespace kaboum::plan
