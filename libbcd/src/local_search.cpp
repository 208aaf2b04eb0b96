// Local search among bodies that are unions of pieces. docs/algorithms/convex-decomposition.md,
// "Search".

#include "local_search.h"

#include <kaboum/base/parallel.h>

#include <algorithm>
#include <limits>

namespace kaboum::bcd {

/// Gives a piece of a body to another one if both are then better than the body was.
bool LocalSearch::move_piece(std::vector<Body>& bodies, std::size_t from) const {
  const CutTree& tree = state_.tree();
  const SolidField& solid = state_.solid();
  const Body& donor = bodies[from];
  if (donor.leaves.size() < 2) return false;
  const std::vector<int> pieces = nodes_of(tree, donor, kPieces);
  struct Move {
    std::size_t piece, to;
    double worst = std::numeric_limits<double>::infinity();
  };
  std::vector<Move> moves;
  std::vector<Body> rests(pieces.size()), parts(pieces.size());
  parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
    std::vector<int> rest = pieces;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    rests[i] = union_of(tree, solid, rest);
    parts[i] = body_of(tree, pieces[i]);
  });
  const double limit = kMoveGain * donor.concavity.worst;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    if (rests[i].concavity.worst >= limit) continue;
    for (std::size_t to = 0; to < bodies.size(); ++to)
      if (to != from && touch(parts[i], bodies[to], solid)) moves.push_back({i, to});
  }
  parallel_for(std::size_t{0}, moves.size(), [&](std::size_t i) {
    Move& m = moves[i];
    m.worst = std::max(estimate_union(bodies[m.to], parts[m.piece], solid, limit).worst,
                       rests[m.piece].concavity.worst);
  });
  const auto best = std::min_element(
      moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.worst < b.worst; });
  if (best == moves.end() || best->worst >= limit) return false;
  Body recipient = union_of(bodies[best->to], parts[best->piece], solid);
  if (recipient.concavity.worst >= limit) return false;
  bodies[best->to] = std::move(recipient);
  bodies[from] = std::move(rests[best->piece]);
  return true;
}

/// Splits a body and a neighbour anew, by a plane that leaves both nearer to the solid than this
/// share of the body's distance.
bool LocalSearch::resplit(std::vector<Body>& bodies, std::size_t from, double gain) {
  CutTree& tree = state_.tree();
  const SolidField& solid = state_.solid();
  const double limit = gain * bodies[from].concavity.worst;
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (i != from && touch(bodies[from], bodies[i], solid)) near.push_back(i);
  std::sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
    const double x = bodies[a].concavity.worst, y = bodies[b].concavity.worst;
    return x != y ? x < y : a < b;
  });
  if (near.size() > kResplitNeighbours) near.resize(kResplitNeighbours);
  CutTree::Split best;
  std::size_t with = from;
  for (const std::size_t i : near) {
    const auto split = tree.find_split(nodes_of(tree, bodies[from], bodies[i]),
                                       bodies[from].box.center() - bodies[i].box.center(),
                                       std::min(limit, best.worst));
    if (!split) continue;
    best = *split;
    with = i;
  }
  if (with == from) return false;
  std::vector<int> lower, upper;
  tree.split(nodes_of(tree, bodies[from], bodies[with]), best.plane, lower, upper);
  if (lower.empty() || upper.empty()) return false;
  Body a = union_of(tree, solid, lower), b = union_of(tree, solid, upper);
  if (std::max(a.concavity.worst, b.concavity.worst) > limit) return false;
  bodies[from] = std::move(a);
  bodies[with] = std::move(b);
  return true;
}

/// Splits those that are nearly as far as the worst anew, each with a neighbour: distances along a
/// chain of bodies become alike, step by step.
bool LocalSearch::relax_chain(std::vector<Body>& bodies) {
  const double limit = kChainFrom * worst_of(bodies);
  bool changed = false;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].concavity.worst > limit) changed = resplit(bodies, i, kChainGain) || changed;
  return changed;
}

/// Merges others in place of a body's parts. @return whether all are then nearer than it was.
bool LocalSearch::split_and_merge(std::vector<Body>& bodies, std::size_t which,
                                  const std::vector<Body>& parts, std::size_t target) {
  const double limit = bodies[which].concavity.worst;
  std::vector<Body> changed;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (i != which) changed.push_back(bodies[i]);
  changed.insert(changed.end(), parts.begin(), parts.end());
  for (const double weight : state_.tuning().volume_weights) {
    std::vector<Body> fewer = state_.merged(changed, target, kMoveGain * limit, weight);
    if (fewer.size() > target || worst_of(fewer) >= limit) continue;
    bodies = std::move(fewer);
    return true;
  }
  return false;
}

void LocalSearch::refine(std::vector<Body>& bodies, std::size_t target, bool chains) {
  for (int round = 0; round < state_.tuning().refinements && !bodies.empty(); ++round) {
    if (state_.spent(kImproving)) return;
    std::size_t worst = 0;
    for (std::size_t i = 1; i < bodies.size(); ++i)
      if (bodies[i].concavity.worst > bodies[worst].concavity.worst) worst = i;
    if (move_piece(bodies, worst) || resplit(bodies, worst)) continue;
    const std::vector<Body> parts = split_body(bodies[worst], bodies[worst].concavity.worst);
    if (parts.size() > 1 && split_and_merge(bodies, worst, parts, target)) continue;
    if (!(chains && relax_chain(bodies))) return;
  }
}

std::vector<Body> LocalSearch::split_body(const Body& body, double epsilon, bool all) {
  CutTree& tree = state_.tree();
  std::vector<Body> parts;
  if (body.leaves.size() == 1) {
    const int leaf = body.leaves[0];
    const CutTree::Node& node = tree.nodes()[leaf];
    const bool cut = node.lower >= 0 || node.upper >= 0;
    // Where only the vertices allowed are too few, any smaller parts will do.
    const bool near = !all && node.concavity.worst <= kHalvedBelow * epsilon;
    if (!cut && !(near && tree.halve(leaf)) && (node.stuck || !tree.cut(leaf))) return {};
    for (const int child : {tree.nodes()[leaf].lower, tree.nodes()[leaf].upper})
      if (child >= 0) parts.push_back(body_of(tree, child));
    if (parts.size() == 1) return split_body(parts[0], epsilon, all);
    return parts;
  }
  for (const int node : nodes_of(tree, body, kPieces, epsilon))
    parts.push_back(body_of(tree, node));
  if (all) return parts;
  return state_.merged(std::move(parts), 2, epsilon);
}

}  // namespace kaboum::bcd
