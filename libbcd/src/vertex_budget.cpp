// A limit on the vertices of all bodies together: numbers of bodies are tried, then distances.
// docs/algorithms/convex-decomposition.md, "A limit on all vertices together".

#include "vertex_budget.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "body_removal.h"

namespace kaboum::bcd {

std::vector<Finished> VertexBudget::nearest_that_fit() {
  const CoverOptions& options = state_.options();
  const std::size_t total = *options.max_total_vertices;
  const std::size_t most = std::min(options.max_bodies.value_or(kUnlimited),
                                    std::max<std::size_t>(1, total / kVerticesPerBody));
  std::vector<Finished> best = by_number(most, total);
  if (state_.tuning().reduce && fits(best, options)) by_distance(best, most, total);
  return best;
}

/// Fewer bodies go farther, but leave more vertices to each.
std::vector<Finished> VertexBudget::by_number(std::size_t most, std::size_t total) {
  const CoverOptions& options = state_.options();
  std::vector<Finished> best;
  std::size_t last = 0;
  for (double share = 1; share > kLeastBudgetShare; share *= kBudgetShare) {
    const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(most)));
    if (count == last) continue;
    if (!best.empty() && state_.spent(kImproving)) break;
    last = count;
    std::vector<Finished> tried = count_.at_most(count);
    if (!best.empty() && fits(best, options) && largest_excess(tried) > largest_excess(best)) break;
    simplify_to(tried, total);
    if (best.empty() ||
        (fits(tried, options) ? !fits(best, options) || largest_excess(tried) < largest_excess(best)
                              : vertices_of(tried) < vertices_of(best)))
      best = std::move(tried);
  }
  return best;
}

/// Bodies too far are split, and fewer looked for.
void VertexBudget::by_distance(std::vector<Finished>& best, std::size_t most, std::size_t total) {
  const CoverOptions& options = state_.options();
  int tries = kBudgetTries;
  for (double step = kBudgetStep; step > kLeastBudgetStep && tries > 0 && !state_.spent(kImproving);
       --tries) {
    const double epsilon = (1 - step) * largest_excess(best);
    if (!(epsilon > kLeastBudgetDistance * state_.solid().diagonal())) break;
    std::vector<Finished> tried = within_.within(epsilon);
    for (const std::size_t enough : {most, std::size_t{1}}) {
      const bool looked = tried.size() > enough || enough == 1;
      if (looked) {
        within_.reduce(tried, epsilon, enough);
        remove_bodies(state_, finisher_, tried, epsilon);
      }
      finisher_.simplify_hulls(tried, epsilon);
      const bool near =
          static_cast<double>(vertices_of(tried)) < kNearBudget * static_cast<double>(total);
      if (fits(tried, options) || tried.size() > most || (looked && !near)) break;
    }
    if (fits(tried, options) && largest_excess(tried) < largest_excess(best)) {
      best = std::move(tried);
    } else {
      step *= 0.5;
    }
  }
}

/// At most this many vertices, with the smallest distance that allows it.
void VertexBudget::simplify_to(std::vector<Finished>& bodies, std::size_t total) {
  if (vertices_of(bodies) <= total) return;
  const auto simplified = [&](double epsilon) {
    std::vector<Finished> out = bodies;
    finisher_.simplify_hulls(out, epsilon);
    return out;
  };
  const double diagonal = state_.solid().diagonal();
  double low = std::max(largest_excess(bodies), kLeastThinned * diagonal), high = low;
  std::vector<Finished> best = simplified(high);
  while (vertices_of(best) > total && high < diagonal) {
    low = high;
    high *= kThinnedGrowth;
    best = simplified(high);
  }
  while (vertices_of(best) <= total && high > kThinnedRatio * low) {
    const double middle = std::sqrt(low * high);
    std::vector<Finished> tried = simplified(middle);
    if (vertices_of(tried) <= total) {
      high = middle;
      best = std::move(tried);
    } else {
      low = middle;
    }
  }
  bodies = std::move(best);
}

}  // namespace kaboum::bcd
