// A given number of bodies: the solid is cut into somewhat more pieces, these are merged in several
// ways, and the best is improved. docs/algorithms/convex-decomposition.md, "Search".

#include "count_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace kaboum::bcd {

bool add_witness(SearchState& state, const Finished& f) {
  if (f.excess.lower <= kMisjudged * f.body.concavity.worst) return false;
  return state.add_witness({f.excess.at, f.excess.lower / f.excess.weight}, f.body.hull);
}

/// At most this many bodies, the first attempts of all that come nearest to the solid; none when
/// that is not below `limit`.
std::vector<Body> CountSearch::best_merge(const std::vector<std::vector<Body>>& snapshots,
                                          std::size_t target, double limit) {
  std::vector<Body> best;
  if (snapshots[0].size() <= target && worst_of(snapshots[0]) < limit) {
    best = snapshots[0];
    limit = worst_of(best);
  }
  for (const auto& snapshot : snapshots) {
    for (const double weight : state_.tuning().volume_weights) {
      if (!best.empty() && state_.spent(kImproving)) return best;
      std::vector<Body> bodies = state_.merged(snapshot, target, limit, weight);
      if (bodies.size() > target) continue;
      const double worst = worst_of(bodies);
      if (worst >= limit) continue;
      limit = worst;
      best = std::move(bodies);
    }
  }
  return best;
}

/// The pieces that there are when there are several multiples of `target`.
std::vector<std::vector<Body>> CountSearch::cut_for(std::size_t target) {
  CutTree& tree = state_.tree();
  const std::vector<double>& multiples = state_.tuning().multiples;
  const auto pieces = [target](double multiple) {
    return std::ceil(multiple * (static_cast<double>(target) + kFewBodies) - kFewBodies);
  };
  const double most = pieces(multiples.back());
  std::vector<std::vector<Body>> snapshots;
  for (const double multiple : multiples) {
    const double count = pieces(multiple);
    while (static_cast<double>(tree.leaf_count()) < count && !state_.spent(kCutting) &&
           tree.cut_worst())
      state_.report("cutting", 0.7 * static_cast<double>(tree.leaf_count()) / most);
    snapshots.push_back(state_.leaf_bodies(static_cast<std::size_t>(count)));
  }
  return snapshots;
}

std::vector<Body> CountSearch::gather(std::size_t target, double epsilon) {
  state_.begin_cutting();
  if (target == 1) return {body_of(state_.tree(), 0)};
  const std::vector<std::vector<Body>> snapshots = cut_for(target);
  state_.report("merging", 0.7);
  std::vector<Body> bodies = best_merge(snapshots, target, kRoughFactor * epsilon);
  if (bodies.empty() && epsilon == kUnbounded)
    bodies = state_.merged(state_.leaf_bodies(), target, kUnbounded);
  local_.refine(bodies, target, epsilon == kUnbounded);
  return bodies;
}

std::vector<Finished> CountSearch::at_most(std::size_t target) {
  std::vector<Body> bodies = gather(target);
  const double free_cost = kFreeShare * state_.options().simplify_share() * worst_of(bodies);
  // No vertex that need not be left out makes a body the worst.
  const double decisive = kMisjudged * worst_of(bodies);
  std::vector<Finished> finished;
  // What measuring finds is refined once more.
  for (int round = 0; round < state_.tuning().rounds; ++round) {
    if (round > 0 && target > 1) local_.refine(bodies, target);
    state_.report("simplifying", 0.75 + 0.02 * round);
    std::vector<Finished> next = finisher_.finish(bodies, free_cost, decisive);
    bool misjudged = false;
    bodies.clear();
    for (const Finished& f : next) {
      add_witness(state_, f);
      bodies.push_back(f.body);
      Concavity& c = bodies.back().concavity;
      if (f.excess.lower <= kMisjudged * c.worst) continue;
      c.worst = f.excess.lower;
      c.at = f.excess.at;
      misjudged = true;
    }
    if (finished.empty() || largest_excess(next) < largest_excess(finished))
      finished = std::move(next);
    if (!misjudged || state_.spent(kImproving)) break;
  }
  const int rounds = target > 1 ? state_.tuning().refinements / kRefinementsPerRound : 0;
  for (int round = 0; round < rounds; ++round) {
    state_.report("refining", 0.8 + 0.2 * round / rounds);
    if (state_.spent(kImproving) || !improve(finished, target, free_cost)) break;
  }
  finisher_.measure_largest(finished);
  return finished;
}

/// Splits the body with the largest certified distance, and merges others instead. @return false
/// when that did not help.
bool CountSearch::improve(std::vector<Finished>& finished, std::size_t target, double free_cost) {
  finisher_.measure_largest(finished);
  std::size_t worst = 0;
  for (std::size_t i = 1; i < finished.size(); ++i)
    if (finished[i].excess.lower > finished[worst].excess.lower) worst = i;
  const double limit = finished[worst].excess.upper;
  const std::vector<Body> parts = local_.split_body(finished[worst].body, limit);
  if (parts.size() < 2) return false;
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < finished.size(); ++i)
    if (i != worst) bodies.push_back(finished[i].body);
  bodies.insert(bodies.end(), parts.begin(), parts.end());
  bodies = state_.merged(std::move(bodies), target, kReplacedMerge * limit);
  if (bodies.size() > target) return false;
  // Bodies that stayed need not be finished again.
  std::map<std::vector<int>, std::size_t> known;
  for (std::size_t i = 0; i < finished.size(); ++i)
    if (i != worst) known.emplace(finished[i].body.leaves, i);
  std::vector<Body> fresh;
  std::vector<std::size_t> kept;
  for (Body& b : bodies) {
    const auto at = known.find(b.leaves);
    if (at != known.end()) {
      kept.push_back(at->second);
    } else {
      fresh.push_back(std::move(b));
    }
  }
  std::vector<Finished> changed = finisher_.finish(fresh, free_cost, limit);
  for (const Finished& f : changed)
    if (f.excess.upper >= kReplacedGain * limit) return false;
  for (const std::size_t i : kept) changed.push_back(std::move(finished[i]));
  finished = std::move(changed);
  return true;
}

}  // namespace kaboum::bcd
