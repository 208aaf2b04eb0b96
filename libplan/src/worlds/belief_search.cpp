// And-or search over beliefs by weak plans and obligations, on one graph with backward labels.
#include "worlds/belief_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "task/knowledge.h"

namespace kaboum::plan::worlds {
namespace {

constexpr std::size_t kMostFailures = 200;
constexpr std::size_t kDeepest = 20'000;

constexpr std::size_t kFirstTurn = 4'000;

using Sensed = std::vector<std::pair<Index, Index>>;

/// How many worlds a belief has, as a logarithm.
int spread(const BeliefSpace& space, const Word* belief) {
  double sum = 0;
  for (Index c = 0; c < space.task().components.size(); ++c)
    sum += std::log2(space.sets(c).members(space.set_of(c, belief)).count);
  return static_cast<int>(sum * 16);
}

/// Whether no variable has one value here and another there.
bool agree(const Sensed& a, const Sensed& b) {
  return std::ranges::all_of(a, [&](const auto& x) {
    return std::ranges::none_of(
        b, [&](const auto& y) { return x.first == y.first && x.second != y.second; });
  });
}

/// Thrown out of nested obligations when they fail too often.
struct TooManyFailures {};
/// The same when the turn is over.
struct TurnIsOver {};

}  // namespace

BeliefSearch::BeliefSearch(BeliefSpace& space, const Model& model, bool guided, Limits& limits,
                           Statistics& statistics)
    : space_(space),
      guided_(guided),
      limits_(limits),
      statistics_(statistics),
      estimates_(space, limits),
      policy_(space, model),
      store_(static_cast<Index>(std::max<std::size_t>(space.words(), 1))) {}

void BeliefSearch::check_limits() {
  const std::size_t bytes =
      store_.bytes() + space_.bytes() + estimates_.bytes() + policy_.bytes() +
      nodes_.size() * (sizeof(Node) + 40) + edges_.size() * sizeof(Edge) +
      outcomes_.size() * (sizeof(Index) + sizeof(decltype(sensed_)::value_type) + 16);
  statistics_.states = nodes_.size();
  statistics_.state_bytes = bytes;
  if (limits_.check(bytes)) throw LimitExceeded();
}

Index BeliefSearch::node(const Word* belief) {
  const auto words = static_cast<Index>(space_.words());
  const auto [n, fresh] = store_.insert(belief, Knowledge::hash_of(belief, words), kNone, 0);
  if (!fresh) return n;
  nodes_.emplace_back();
  seen_.push_back(0);
  came_.push_back({});
  open_obligation_.push_back(0);
  nodes_[n].entry = policy_.find(belief);
  return n;
}

int BeliefSearch::estimate(Index n) {
  if (!guided_) return 0;
  int& h = nodes_[n].estimates.at(static_cast<std::size_t>(guide_));
  if (h < 0) {
    h = estimates_(guide_, store_[n]);
    if (h >= BeliefEstimates::kDead) bury(n);
  }
  return h;
}

void BeliefSearch::expand(Index n) {
  if (nodes_[n].expanded) return;
  ++statistics_.expanded;
  check_limits();
  const BeliefWords belief(store_[n], store_[n] + space_.words());
  const auto first = static_cast<Index>(edges_.size());
  const auto& operators = space_.task().operators;
  for (Index o = 0; o < operators.size(); ++o) {
    if (!space_.holds(operators[o].precondition, belief.data())) continue;
    const std::vector<Outcome> made = space_.apply(operators[o], belief.data());
    if (std::any_of(made.begin(), made.end(), [&](const Outcome& m) { return m.belief == belief; }))
      continue;  // never part of a plan without cycles
    if (made.empty()) continue;
    Edge e;
    e.source = n;
    e.op = o;
    e.first = static_cast<Index>(outcomes_.size());
    e.outcomes = static_cast<Index>(made.size());
    for (const Outcome& m : made) {
      ++statistics_.generated;
      outcomes_.push_back(node(m.belief.data()));
      sensed_.push_back(m.sensed);
    }
    edges_.push_back(e);
  }
  nodes_[n].expanded = true;
  nodes_[n].first_edge = first;
  nodes_[n].edges = static_cast<Index>(edges_.size()) - first;
  for (Index e = first; e < edges_.size(); ++e) {
    for (Index i = 0; i < edges_[e].outcomes; ++i) {
      Node& to = nodes_[outcomes_[edges_[e].first + i]];
      to.incoming.push_back(e);
      if (to.entry == kNone) ++edges_[e].unsolved;
      edges_[e].dead |= to.dead;
    }
  }
  for (Index e = first; e < edges_.size() && nodes_[n].entry == kNone; ++e)
    if (edges_[e].unsolved == 0) {
      solve(n, enter(edges_[e]));
    }
  if (nodes_[n].entry == kNone &&
      std::all_of(edges_.begin() + first, edges_.end(), [](const Edge& e) { return e.dead; }))
    bury(n);
}

/// An entry of the policy for a step all outcomes of which are solved.
Index BeliefSearch::enter(const Edge& e) {
  std::vector<BeliefPolicy::Case> cases;
  for (Index i = e.first; i < e.first + e.outcomes; ++i)
    cases.push_back({sensed_[i], nodes_[outcomes_[i]].entry});
  return policy_.add(store_[e.source], e.op, std::move(cases));
}

/// The node, and all before it that are thereby solved, get entries of the policy.
void BeliefSearch::solve(Index n, Index entry) {
  nodes_[n].entry = entry;
  std::vector<Index> todo = {n};
  while (!todo.empty()) {
    const Index at = todo.back();
    todo.pop_back();
    for (std::size_t i = 0; i < nodes_[at].incoming.size(); ++i) {
      const Index number = nodes_[at].incoming[i];
      Edge& e = edges_[number];
      if (--e.unsolved > 0 || nodes_[e.source].entry != kNone) continue;
      nodes_[e.source].entry = enter(e);
      todo.push_back(e.source);
    }
  }
}

/// The node has no plan, nor have those before it that need it.
void BeliefSearch::bury(Index n) {
  std::vector<Index> todo = {n};
  nodes_[n].dead = true;
  while (!todo.empty()) {
    const Index at = todo.back();
    todo.pop_back();
    ++statistics_.dead_ends;
    for (const Index e : nodes_[at].incoming) {
      edges_[e].dead = true;
      Node& source = nodes_[edges_[e].source];
      if (source.dead || source.entry != kNone || !source.expanded) continue;
      const auto begin = edges_.begin() + source.first_edge;
      if (!std::all_of(begin, begin + source.edges, [](const Edge& k) { return k.dead; })) continue;
      source.dead = true;
      todo.push_back(edges_[e].source);
    }
  }
}

bool BeliefSearch::usable(const Edge& e) const {
  if (e.dead || e.blocked) return false;
  for (Index i = e.first; i < e.first + e.outcomes; ++i)
    if (open_obligation_[outcomes_[i]] != 0 && nodes_[outcomes_[i]].entry == kNone) return false;
  return true;
}

/// A way from a node to a solved one, outcomes chosen at will. `proved`: if there is none, there
/// is none for any node that was seen either.
std::optional<BeliefSearch::Path> BeliefSearch::weak_plan(Index from, bool& proved) {
  ++statistics_.searches;
  ++search_;
  using Item = std::tuple<int, int, Index>;  // keys, node; the first in is the first out
  using Queue = std::priority_queue<std::pair<Item, std::size_t>,
                                    std::vector<std::pair<Item, std::size_t>>, std::greater<>>;
  Queue nearest, surest;
  std::size_t order = 0;
  const auto push = [&](Index n) {
    const int h = estimate(n);
    if (nodes_[n].dead) return;
    ++order;
    const bool by_spread = guided_ && guide_ == Guide::Worlds;
    const int s = by_spread ? spread(space_, store_[n]) : 0;
    nearest.push({{h, s, n}, order});
    if (by_spread) surest.push({{s, h, n}, order});
  };
  const auto path = [&](Index to) {
    Path p;
    for (Index n = to; n != from; n = edges_[came_[n].edge].source) p.push_back(came_[n]);
    std::reverse(p.begin(), p.end());
    return p;
  };
  std::vector<Index> seen = {from};
  seen_[from] = search_;
  push(from);
  std::vector<char> closed(nodes_.size(), 0);
  proved = true;
  for (bool turn = false; !nearest.empty() || !surest.empty(); turn = !turn) {
    Queue& queue = (turn && !surest.empty()) || nearest.empty() ? surest : nearest;
    const Index n = std::get<2>(queue.top().first);
    queue.pop();
    if (closed.size() < nodes_.size()) closed.resize(nodes_.size() * 2, 0);
    if (closed[n] != 0 || nodes_[n].dead) continue;
    closed[n] = 1;
    if (nodes_[n].entry != kNone) return path(n);
    if (const Index e = policy_.find(store_[n]); e != kNone) {
      solve(n, e);
      ++statistics_.reused;
      return path(n);
    }
    if (statistics_.expanded >= turn_end_) throw TurnIsOver();
    expand(n);
    if (nodes_[n].entry != kNone) return path(n);
    for (Index e = nodes_[n].first_edge; e < nodes_[n].first_edge + nodes_[n].edges; ++e) {
      if (edges_[e].dead) continue;
      if (!usable(edges_[e])) {
        proved = false;
        continue;
      }
      for (Index i = edges_[e].first; i < edges_[e].first + edges_[e].outcomes; ++i) {
        const Index to = outcomes_[i];
        if (seen_[to] == search_ || nodes_[to].dead) continue;
        seen_[to] = search_;
        seen.push_back(to);
        came_[to] = {e, i};
        if (nodes_[to].entry != kNone) return path(to);
        push(to);
      }
    }
  }
  if (proved)
    for (const Index n : seen)
      if (!nodes_[n].dead) bury(n);
  return std::nullopt;
}

/// The way with one hop left out; nullopt if the rest does not lead to a solved node then.
std::optional<BeliefSearch::Path> BeliefSearch::replay(Index from, const Path& path,
                                                       std::size_t without) {
  Path made;
  Index at = without == 0 ? from : outcomes_[path[without - 1].outcome];
  for (std::size_t i = without + 1; i < path.size(); ++i) {
    if (nodes_[at].entry != kNone) break;
    expand(at);
    const Edge old = edges_[path[i].edge];
    Index found = kNone;
    for (Index e = nodes_[at].first_edge; e < nodes_[at].first_edge + nodes_[at].edges; ++e)
      if (edges_[e].op == old.op && usable(edges_[e])) found = e;
    if (found == kNone) return std::nullopt;
    Index outcome = edges_[found].first;
    const Index end = outcome + edges_[found].outcomes;
    while (outcome < end && !agree(sensed_[path[i].outcome], sensed_[outcome])) ++outcome;
    if (outcome == end || nodes_[outcomes_[outcome]].dead) return std::nullopt;
    made.push_back({found, outcome});
    at = outcomes_[outcome];
  }
  if (nodes_[at].entry == kNone) return std::nullopt;
  Path all(path.begin(), path.begin() + static_cast<long>(without));
  all.insert(all.end(), made.begin(), made.end());
  return all;
}

/// Each outcome that is sensed on the way has to be planned for: what leads there without it goes.
void BeliefSearch::leave_needless_sensing_out(Index from, Path& path) {
  for (std::size_t i = path.size(); i-- > 0;) {
    if (i >= path.size() || edges_[path[i].edge].outcomes == 1) continue;
    if (auto shorter = replay(from, path, i)) path = std::move(*shorter);
  }
}

bool BeliefSearch::achieve(Index n) {
  if (++depth_ > kDeepest) throw TooManyFailures();
  std::vector<Index> blocked;
  bool success = false;
  while (true) {
    if (nodes_[n].entry != kNone) {
      success = true;
      break;
    }
    if (nodes_[n].dead) break;
    bool proved = false;
    std::optional<Path> path = weak_plan(n, proved);
    if (!path) break;
    leave_needless_sensing_out(n, *path);
    bool failed = false;
    for (auto hop = path->rbegin(); hop != path->rend() && !failed; ++hop) {
      const Edge e = edges_[hop->edge];
      for (Index i = e.first; i < e.first + e.outcomes && !failed; ++i) {
        const Index o = outcomes_[i];
        if (nodes_[o].entry != kNone) continue;
        if (!nodes_[o].dead && open_obligation_[o] == 0) {
          open_obligation_[o] = 1;
          achieve(o);
          open_obligation_[o] = 0;
        }
        if (nodes_[o].entry != kNone) continue;
        failed = true;
        if (++failures_ > kMostFailures) throw TooManyFailures();
        if (!edges_[hop->edge].blocked) {
          edges_[hop->edge].blocked = true;
          blocked.push_back(hop->edge);
        }
      }
    }
  }
  for (const Index e : blocked) edges_[e].blocked = false;
  --depth_;
  return success;
}

bool BeliefSearch::all_solved() const {
  return std::ranges::all_of(roots_, [&](Index r) { return nodes_[r].entry != kNone; });
}

bool BeliefSearch::done() const {
  return all_solved() || std::ranges::any_of(roots_, [&](Index r) { return nodes_[r].dead; });
}

/// Expands all there is.
bool BeliefSearch::exhaust() {
  for (Index n = 0; n < nodes_.size() && !done(); ++n) {
    if (nodes_[n].entry != kNone || nodes_[n].dead) continue;
    if (const Index e = policy_.find(store_[n]); e != kNone)
      solve(n, e);
    else
      expand(n);
  }
  return all_solved();
}

/// Plans for all roots, repairs included, until so many nodes are expanded.
BeliefSearch::Attempt BeliefSearch::attempt(Guide guide, std::size_t most_expanded) {
  guide_ = guide;
  turn_end_ = most_expanded;
  failures_ = depth_ = 0;
  Attempt result = Attempt::Failed;
  try {
    if (std::all_of(roots_.begin(), roots_.end(), [&](Index r) { return achieve(r); }))
      return Attempt::Solved;
  } catch (const TooManyFailures&) {
  } catch (const TurnIsOver&) {
    result = Attempt::TurnOver;
  }
  std::fill(open_obligation_.begin(), open_obligation_.end(), 0);
  for (Edge& e : edges_) e.blocked = false;
  return result;
}

/// Both guides in turn, each for as long as its repairs do not fail; what one has solved the other
/// finds.
bool BeliefSearch::take_turns() {
  constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();
  if (!guided_) return attempt(Guide::Worlds, kUnlimited) == Attempt::Solved;
  std::vector<Guide> guides = {Guide::Knowledge, Guide::Worlds};
  for (std::size_t turn = kFirstTurn; !guides.empty() && !done(); turn *= 2)
    std::erase_if(guides, [&](Guide g) {
      const std::size_t end = guides.size() == 1 ? kUnlimited : statistics_.expanded + turn;
      return !done() && attempt(g, end) == Attempt::Failed;
    });
  return all_solved();
}

kaboum::plan::Outcome BeliefSearch::run(const std::vector<Outcome>& start) {
  for (const Outcome& o : start) {
    roots_.push_back(node(o.belief.data()));
    root_sensed_.push_back(o.sensed);
  }
  if (guided_) {
    int most = 0;
    for (const Index r : roots_) most = std::max(most, estimate(r));
    statistics_.initial_estimate = most;
  }
  const bool solved = take_turns() || exhaust();
  check_limits();
  return solved ? kaboum::plan::Outcome::Solved : kaboum::plan::Outcome::Unsolvable;
}

Plan BeliefSearch::plan() const {
  std::vector<BeliefPolicy::Case> start;
  for (std::size_t r = 0; r < roots_.size(); ++r)
    start.push_back({root_sensed_[r], nodes_[roots_[r]].entry});
  return policy_.plan(start);
}

}  // namespace kaboum::plan::worlds
