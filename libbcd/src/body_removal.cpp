// One body less: its pieces go to its neighbours, as long as these stay near the solid.
// docs/algorithms/convex-decomposition.md, "Search".

#include "body_removal.h"

#include <kaboum/base/parallel.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace kaboum::bcd {
namespace {

/// Gives pieces to recipients, the best pair first, within a distance.
class Distribution {
 public:
  Distribution(const SolidField& solid, std::vector<Body> pieces, std::vector<Body>& recipients,
               double limit)
      : solid_(solid),
        pieces_(std::move(pieces)),
        recipients_(recipients),
        limit_(limit),
        worst_(pieces_.size() * recipients.size()),
        given_(pieces_.size(), 0),
        changed_(recipients.size(), 0) {}

  /// @return whether all pieces are given; the recipients have grown then.
  bool run() {
    for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
      parallel_for(std::size_t{0}, recipients_.size(),
                   [&](std::size_t to) { estimate(piece, to); });
      if (worst_[best_of(piece)] > limit_) return false;
    }
    for (std::size_t left = pieces_.size(); left > 0; --left) {
      const std::optional<std::size_t> best = best_pair();
      if (!best) return false;
      const std::size_t piece = *best / recipients_.size(), to = *best % recipients_.size();
      recipients_[to] = union_of(recipients_[to], pieces_[piece], solid_);
      given_[piece] = changed_[to] = 1;
      parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t other) {
        if (given_[other] == 0) estimate(other, to);
      });
    }
    return true;
  }

  [[nodiscard]] bool changed(std::size_t recipient) const { return changed_[recipient] != 0; }

 private:
  /// How far a recipient would be with a piece; one too far stays so as it grows.
  void estimate(std::size_t piece, std::size_t to) {
    double& w = worst_[piece * recipients_.size() + to];
    if (w <= limit_) w = estimate_union(recipients_[to], pieces_[piece], solid_, limit_).worst;
  }
  /// The best place for a piece, as an index of worst_.
  [[nodiscard]] std::size_t best_of(std::size_t piece) const {
    const auto count = static_cast<std::ptrdiff_t>(recipients_.size());
    const auto first = worst_.begin() + static_cast<std::ptrdiff_t>(piece) * count;
    return static_cast<std::size_t>(std::min_element(first, first + count) - worst_.begin());
  }
  /// Nothing where a piece has no place any more.
  [[nodiscard]] std::optional<std::size_t> best_pair() const {
    std::optional<std::size_t> best;
    for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
      if (given_[piece] != 0) continue;
      const std::size_t pair = best_of(piece);
      if (worst_[pair] > limit_) return std::nullopt;
      if (!best || worst_[pair] < worst_[*best]) best = pair;
    }
    return best;
  }

  const SolidField& solid_;
  std::vector<Body> pieces_;
  std::vector<Body>& recipients_;
  double limit_;
  std::vector<double> worst_;  // distance of the union, by piece and then by recipient
  std::vector<char> given_, changed_;
};

/// The body in its coarsest parts, but at least some.
std::vector<Body> pieces_of(SearchState& state, const Body& body) {
  CutTree& tree = state.tree();
  std::vector<int> nodes = nodes_of(tree, body, kRemovedPieces);
  for (std::size_t from = 0; nodes.size() < kLeastRemovedPieces && from < nodes.size();) {
    const int leaf = nodes[from];
    if (tree.nodes()[leaf].stuck || !tree.cut(leaf)) {
      ++from;
      continue;
    }
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(from));
    tree.leaves_below(leaf, nodes);
  }
  std::vector<Body> out;
  out.reserve(nodes.size());
  for (const int node : nodes) out.push_back(body_of(tree, node));
  return out;
}

/// Gives the pieces of a body to its neighbours. @return whether these stay within epsilon, which
/// is one body less.
bool redistribute(SearchState& state, Finisher& finisher, std::vector<Finished>& bodies,
                  std::size_t which, double epsilon) {
  const double limit = kAimedShare * epsilon;
  const Body& body = bodies[which].body;
  std::vector<Body> recipients;
  std::vector<std::size_t> origin;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i == which || !touch(body, bodies[i].body, state.solid())) continue;
    recipients.push_back(bodies[i].body);
    origin.push_back(i);
  }
  if (recipients.empty()) return false;
  Distribution distribution(state.solid(), pieces_of(state, body), recipients, limit);
  if (!distribution.run()) return false;
  std::vector<Body> fresh;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < recipients.size(); ++i) {
    if (!distribution.changed(i)) continue;
    fresh.push_back(std::move(recipients[i]));
    place.push_back(origin[i]);
  }
  std::vector<Finished> finished =
      finisher.finish(fresh, state.options().simplify_share() * limit, epsilon);
  if (!are_within(finished, epsilon)) return false;
  for (std::size_t i = 0; i < place.size(); ++i) bodies[place[i]] = std::move(finished[i]);
  bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(which));
  return true;
}

}  // namespace

void remove_bodies(SearchState& state, Finisher& finisher, std::vector<Finished>& bodies,
                   double epsilon, std::size_t enough) {
  if (!are_within(bodies, epsilon)) return;
  std::sort(bodies.begin(), bodies.end(), [](const Finished& a, const Finished& b) {
    const double x = a.body.concavity.volume, y = b.body.concavity.volume;
    return x != y ? x < y : a.body.leaves < b.body.leaves;
  });
  for (std::size_t i = 0;
       i < bodies.size() && bodies.size() > enough && !state.spent(kImproving);) {
    state.report("dissolving", 0.99);
    if (redistribute(state, finisher, bodies, i, epsilon)) {
      state.improved();
    } else {
      ++i;
    }
  }
}

}  // namespace kaboum::bcd
