// And-or search over all states, as a least fixed point that is computed backwards from the
// targets.
#include "search/exhaustive.h"

#include <algorithm>

namespace kaboum::plan {

Exhaustive::Exhaustive(const SearchInput& in) : in_(in), store_(in.task.layout().words()) {
  store_.insert(in.start.data(), Knowledge::hash_of(in.start.data(), in.task.layout().words()),
                kNone, 0);
}

/// Steps out of one state: an edge for each action and for each value that can be branched on.
void Exhaustive::expand(Index state) {
  Task& task = in_.task;
  std::vector<OperatorId> steps;
  Knowledge scratch(task.layout());
  task.expand(store_[state], steps);
  ++in_.statistics.expanded;
  Index fluent = kNone;  // of the branch at hand
  for (const OperatorId step : steps) {
    const Index of = task.is_outcome(step) ? task.outcome(step).fluent : kNone;
    if (of != kNone && !in_.target.expects(store_[state], step)) continue;
    scratch.assign(store_[state]);
    if (!task.apply(step, scratch)) continue;
    ++in_.statistics.generated;
    if (of == kNone || of != fluent)
      edges_.push_back({state, static_cast<Index>(targets_.size()), 0, 0});
    fluent = of;
    ++edges_.back().count;
    targets_.push_back(store_.insert(scratch.words(), scratch.hash(), state, step).first);
    steps_.push_back(step);
  }
}

bool Exhaustive::explore(std::size_t most_states) {
  for (Index i = 0; i < store_.size(); ++i) {
    const std::size_t bytes =
        store_.bytes() + edges_.capacity() * sizeof(Edge) + targets_.capacity() * 3 * sizeof(Index);
    in_.statistics.states = std::max<std::uint64_t>(in_.statistics.states, store_.size());
    in_.statistics.state_bytes = std::max<std::uint64_t>(in_.statistics.state_bytes, bytes);
    if (store_.size() > most_states || in_.limits.exceeded(bytes)) return false;
    has_plan_.push_back(0);
    if (in_.target.reached(store_[i])) {
      has_plan_[i] = 1;
      solved_.push_back(i);
    } else {
      expand(i);
    }
  }
  return true;
}

Outcome Exhaustive::run(std::size_t most_states) {
  if (!explore(most_states)) return Outcome::Limit;
  // Edges into each state, then back from the targets.
  std::vector<Index> begin(store_.size() + 1, 0);
  for (const Index t : targets_) ++begin[t + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<Index> into(targets_.size());
  std::vector<Index> next = begin;
  for (Index e = 0; e < edges_.size(); ++e) {
    edges_[e].missing = edges_[e].count;
    for (Index k = 0; k < edges_[e].count; ++k) into[next[targets_[edges_[e].first + k]]++] = e;
  }
  decision_.assign(store_.size(), kNone);
  for (std::size_t i = 0; i < solved_.size(); ++i)
    for (Index k = begin[solved_[i]]; k < begin[solved_[i] + 1]; ++k) {
      Edge& e = edges_[into[k]];
      if (--e.missing > 0 || has_plan_[e.source]) continue;
      has_plan_[e.source] = 1;
      decision_[e.source] = into[k];
      solved_.push_back(e.source);
    }
  return has_plan_[0] ? Outcome::Solved : Outcome::Unsolvable;
}

std::vector<Exhaustive::Decision> Exhaustive::plan() const {
  std::vector<char> wanted(store_.size(), 0);
  wanted[0] = 1;
  for (auto s = solved_.rbegin(); s != solved_.rend(); ++s) {
    if (!wanted[*s] || decision_[*s] == kNone) continue;
    const Edge& e = edges_[decision_[*s]];
    for (Index k = 0; k < e.count; ++k) wanted[targets_[e.first + k]] = 1;
  }
  std::vector<Decision> result;
  std::vector<Index> number(store_.size(), kNone);
  for (const Index s : solved_) {
    if (!wanted[s]) continue;
    Decision d;
    d.state.assign(store_[s], store_[s] + in_.task.layout().words());
    if (decision_[s] != kNone) {
      const Edge& e = edges_[decision_[s]];
      for (Index k = 0; k < e.count; ++k)
        d.cases.emplace_back(steps_[e.first + k], number[targets_[e.first + k]]);
    }
    number[s] = static_cast<Index>(result.size());
    result.push_back(std::move(d));
    if (s == 0) break;
  }
  return result;
}

}  // namespace kaboum::plan
