// Few bodies within a given distance: the solid is cut until its pieces are near enough, these are
// merged, and what measuring finds too far is split. docs/algorithms/convex-decomposition.md,
// "Search".

#include "epsilon_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace kaboum::bcd {

/// The hull of everything, if that is within epsilon: no search finds fewer bodies.
std::vector<Finished> EpsilonSearch::hull_within(double epsilon) {
  const CoverOptions& options = state_.options();
  std::vector<Body> whole{body_of(state_.tree(), 0)};
  if (whole[0].concavity.worst > epsilon) return {};
  std::vector<Finished> out =
      finisher_.finish(whole, options.simplify_share() * kAimedShare * epsilon, epsilon);
  if (!are_within(out, epsilon)) out.clear();
  return out;
}

/// Cuts the farthest leaves until all are within the distance.
/// @param begin, aim  distances between which progress is told.
void EpsilonSearch::cut_until(double distance, std::size_t most_leaves, double begin, double aim) {
  CutTree& tree = state_.tree();
  while (tree.worst() > distance && tree.leaf_count() < most_leaves && !state_.spent(kCutting) &&
         tree.cut_worst())
    state_.report("cutting", 0.6 * std::clamp(std::log(begin / std::max(tree.worst(), 1e-300)) /
                                                  std::log(begin / (0.5 * aim)),
                                              0.0, 1.0));
}

std::vector<Finished> EpsilonSearch::within(double epsilon, std::size_t most) {
  if (std::vector<Finished> one = hull_within(epsilon); !one.empty()) return one;
  state_.begin_cutting();
  const CutTree& tree = state_.tree();
  const double aim = kAimedShare * epsilon;
  constexpr std::size_t kFewestPossible = 2;  // one has been tried
  std::vector<Body> best;
  const double begin = std::max(tree.worst(), epsilon);
  std::size_t most_leaves = kMostLeaves;
  for (const double threshold : state_.tuning().thresholds) {
    cut_until(threshold * aim, most_leaves, begin, aim);
    std::size_t fewest = 0;
    std::vector<Body> parts;
    for (const int node : tree.nodes_within(kMergedFrom * threshold * aim))
      parts.push_back(body_of(tree, node));
    std::size_t tried = 0;
    for (const double weight : state_.tuning().volume_weights) {
      if (tried++ >= state_.tuning().first_weights) break;
      // Of many bodies, each that is needless goes in the end.
      if (!best.empty() && (best.size() > state_.tuning().counted || state_.spent(kImproving)))
        break;
      std::vector<Body> bodies = state_.merged(parts, kFewestPossible, aim, weight);
      fewest = fewest == 0 ? bodies.size() : std::min(fewest, bodies.size());
      if (best.empty() || bodies.size() < best.size()) best = std::move(bodies);
    }
    if (fewest > most) return {};
    most_leaves = std::max(kLeastMostLeaves, kLeavesPerBody * fewest);
  }
  state_.report("simplifying", 0.6);
  return finish_until_within(std::move(best), epsilon, kUnlimited);
}

/// Puts parts in place of bodies, and of such parts, that samples show to be farther than epsilon:
/// these need not be finished. Leaves are sampled more densely first; others were as they were
/// merged. What cannot be split stays, and all does once there are more than `most`.
void EpsilonSearch::split_far(std::vector<Body>& bodies, double epsilon, std::size_t most) {
  std::vector<Body> open = std::exchange(bodies, {});
  while (!open.empty()) {
    Body body = std::move(open.back());
    open.pop_back();
    std::vector<Body> parts;
    if (bodies.size() + open.size() < most && !state_.spent(kFinishing)) {
      if (body.concavity.worst <= epsilon && body.leaves.size() == 1) {
        if (const auto far = far_point(body, state_.solid(), epsilon)) {
          body.concavity.worst = far->distance;
          body.concavity.at = far->point;
        }
      }
      if (body.concavity.worst > epsilon) parts = local_.split_body(body, kAimedShare * epsilon);
    }
    if (parts.size() < 2) {
      bodies.push_back(std::move(body));
    } else {
      std::move(parts.begin(), parts.end(), std::back_inserter(open));
    }
  }
  std::reverse(bodies.begin(), bodies.end());
}

/// Finishes bodies; those too far from the solid are split, until all are within epsilon or there
/// are more than `most`.
std::vector<Finished> EpsilonSearch::finish_until_within(std::vector<Body> bodies, double epsilon,
                                                         std::size_t most) {
  const double aim = kAimedShare * epsilon;
  std::vector<Finished> out;
  const std::size_t most_bodies = std::min(most, kMoreBodies + kTimesBodies * bodies.size());
  for (int round = 0;
       round < kSplitRounds && !bodies.empty() && bodies.size() + out.size() <= most_bodies;
       ++round) {
    split_far(bodies, epsilon, most_bodies - out.size());
    std::vector<Finished> tried =
        finisher_.finish(bodies, state_.options().simplify_share() * aim, epsilon);
    bodies.clear();
    std::vector<Body> misjudged;  // leaves of bodies that were thought to be nearer
    for (Finished& f : tried) {
      // Parts of what was too thin are no thicker.
      if (f.excess.upper <= epsilon || (f.thickened && f.body.concavity.worst <= aim) ||
          state_.spent(kFinishing)) {
        out.push_back(std::move(f));
        continue;
      }
      const bool found = add_witness(state_, f);
      // Where the vertices allowed are too few, or the leaf itself is too far.
      std::vector<Body> parts = local_.split_body(f.body, aim, found);
      if (parts.size() < 2) {
        out.push_back(std::move(f));
      } else {
        auto& to = found ? misjudged : bodies;
        std::move(parts.begin(), parts.end(), std::back_inserter(to));
      }
    }
    for (Body& b : state_.merged(std::move(misjudged), 1, aim)) bodies.push_back(std::move(b));
    state_.report("simplifying", 0.6 + 0.013 * (round + 1));
  }
  if (!bodies.empty())
    for (Finished& f : finisher_.finish(bodies, 0)) out.push_back(std::move(f));
  return out;
}

void EpsilonSearch::reduce(std::vector<Finished>& bodies, double epsilon, std::size_t enough) {
  if (!are_within(bodies, epsilon)) return;
  std::size_t low = std::max({std::size_t{1}, bodies.size() / kReduceFrom, enough - 1});
  while (bodies.size() > low + 1 + bodies.size() / kReduceUntil && bodies.size() > enough &&
         !state_.spent(kImproving)) {
    const std::size_t middle = (low + bodies.size()) / 2;
    if (!replace(bodies, middle, epsilon)) low = middle;
  }
}

/// Other bodies within epsilon if there are fewer, looked for by merging down to `target`.
/// @return whether there are that few.
bool EpsilonSearch::replace(std::vector<Finished>& bodies, std::size_t target, double epsilon) {
  if (target == 0) return false;
  std::vector<Body> rough = count_.gather(target, epsilon);
  // Some too far are split.
  const auto far = static_cast<std::size_t>(std::count_if(
      rough.begin(), rough.end(), [&](const Body& b) { return b.concavity.worst > epsilon; }));
  if (rough.empty() || rough.size() + far >= bodies.size()) return false;
  std::vector<Finished> fewer = finish_until_within(std::move(rough), epsilon, bodies.size() - 1);
  if (fewer.size() >= bodies.size() || !are_within(fewer, epsilon)) return false;
  bodies = std::move(fewer);
  state_.improved();
  return bodies.size() <= target;
}

}  // namespace kaboum::bcd
