// One search for bodies: which of the parts it takes, and what is told of its result.

#include "decomposer.h"

#include <algorithm>
#include <utility>

#include "body_bound.h"
#include "body_removal.h"

namespace kaboum::bcd {
namespace {

/// Appends the bodies to the result, and what is known of them all.
void append(std::vector<Finished> bodies, CoverCandidate& result) {
  for (Finished& f : bodies) {
    // Distances, not times the weight of regions.
    constexpr double kRounded = 1 + 0x1p-50;
    const double weight = f.excess.weight;
    result.excess_lower = std::max(
        result.excess_lower, weight == 1 ? f.excess.lower : f.excess.lower / (weight * kRounded));
    result.excess_upper = std::max(
        result.excess_upper, weight == 1 ? f.excess.upper : f.excess.upper * kRounded / weight);
    result.statistics.vertices += f.hull.vertices.size();
    result.statistics.largest = std::max(result.statistics.largest, f.hull.vertices.size());
    result.statistics.thickened += f.thickened ? 1 : 0;
    result.bodies.push_back({"", std::move(f.hull)});
  }
}

/// Changes in how cuts are scored where a number of bodies is given, or few faces leave few cuts.
Tuning for_task(Tuning how, const Mesh& closed, const CoverOptions& options) {
  if (!options.epsilon) how.search.halving_bonus = kHalvingBonus;
  if (closed.triangles.size() <= kQuickTriangles) how.search.density = kDense;
  return how;
}

}  // namespace

Decomposer::Decomposer(const Mesh& closed, const CoverOptions& options, double work, Tuning how)
    : state_(closed, options, work, for_task(std::move(how), closed, options)) {}

Decomposer::Decomposer(const Mesh& closed, const CoverOptions& options, double work)
    : Decomposer(closed, options, work, tuning(options.effort)) {}

Decomposer::Decomposer(const Decomposer& same, const CoverOptions& options, double work)
    : state_(same.state_, options, work) {}

/// So many bodies that no search brings them down to the limits.
std::size_t Decomposer::hopeless() const {
  const CoverOptions& options = state_.options();
  const std::size_t by_vertices = options.max_total_vertices.value_or(kUnlimited) / kLeastVertices;
  const std::size_t limit = std::min(options.max_bodies.value_or(kUnlimited), by_vertices);
  return limit > kUnlimited / kHopeless ? kUnlimited : kHopeless * limit;
}

/// No fewer bodies than this need be looked for: one has been tried, and others are proved to be
/// too few.
std::size_t Decomposer::fewest_possible(const std::vector<Finished>& bodies) const {
  constexpr std::size_t kTried = 2;
  if (bodies.size() <= kTried || bodies.size() > state_.tuning().counted) return kTried;
  const std::size_t too_few = too_few_bodies(state_.solid().mesh(), state_.solid(),
                                             *state_.options().epsilon, bodies.size() - 1);
  return std::max(kTried, too_few + 1);
}

std::vector<Finished> Decomposer::within_epsilon() {
  const double epsilon = *state_.options().epsilon;
  std::vector<Finished> bodies = within_.within(epsilon, hopeless());
  if (state_.tuning().reduce) {
    state_.begin_improving();
    remove_bodies(state_, finisher_, bodies, epsilon, fewest_possible(bodies));
    if (bodies.size() <= state_.tuning().counted) {
      const std::size_t enough = fewest_possible(bodies), before = bodies.size();
      within_.reduce(bodies, epsilon, enough);
      if (bodies.size() < before) remove_bodies(state_, finisher_, bodies, epsilon, enough);
    }
  }
  if (state_.options().max_total_vertices) finisher_.simplify_hulls(bodies, epsilon);
  return bodies;
}

Stop Decomposer::stop_within(const std::vector<Finished>& bodies) const {
  if (!fits(bodies, state_.options())) return Stop::TooManyBodies;
  if (!(largest_excess(bodies) > *state_.options().epsilon)) return Stop::Done;
  return state_.out_of_work() ? Stop::OutOfWork : Stop::Stuck;
}

CoverCandidate Decomposer::run() {
  const CoverOptions& options = state_.options();
  CoverCandidate result;
  std::vector<Finished> bodies;
  if (options.epsilon) {
    bodies = within_epsilon();
    result.stop = stop_within(bodies);
    if (result.stop == Stop::TooManyBodies) return result;
  } else {
    bodies = options.max_total_vertices ? budget_.nearest_that_fit()
                                        : count_.at_most(*options.max_bodies);
    result.stop = fits(bodies, options) ? Stop::Done : Stop::TooManyBodies;
  }
  result.statistics.out_of_work = state_.out_of_work();
  result.statistics.leaves = state_.tree().leaf_count();
  append(std::move(bodies), result);
  return result;
}

}  // namespace kaboum::bcd
