// The relaxed plan [hoffmann2001ff] with additive costs, by a generalised Dijkstra search.
#include "search/relaxed_plan.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

constexpr std::uint64_t kLargest = std::uint64_t{1}
                                   << 62U;  // additive costs may grow exponentially
constexpr std::uint64_t kMostTries = 16;

}  // namespace

RelaxedPlan::RelaxedPlan(Task& task, Relaxation& relaxation)
    : task_(task), relaxation_(relaxation) {
  goal_ = relaxation.node(task.goal());
  const auto& nodes = relaxation.nodes();
  parents_.resize(nodes.size());
  achieves_.resize(nodes.size());
  for (Index n = 0; n < nodes.size(); ++n)
    for (const Index c : nodes[n].children) parents_[c].push_back(n);
  for (Index o = 0; o < relaxation.operators().size(); ++o)
    achieves_[relaxation.operators()[o].node].push_back(o);
}

void RelaxedPlan::settle(Index node, std::uint64_t cost, Index supporter) {
  if (cost >= cost_[node]) return;
  cost_[node] = cost;
  supporter_[node] = supporter;
  queue_.emplace_back(cost, node);
  std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
}

std::uint64_t RelaxedPlan::cost_of(OperatorId step) const {
  if (task_.is_outcome(step)) return 0;
  const GroundAction& a = task_.action(step);
  const std::uint64_t tries = (std::uint64_t{a.granted} + a.refused + 1) / (a.granted + 1);
  return static_cast<std::uint64_t>(std::max<std::int64_t>(1, a.cost)) *
         std::min(tries, kMostTries);
}

std::uint64_t RelaxedPlan::evaluate(const Word* state) {
  const auto& nodes = relaxation_.nodes();
  const auto& fluents = task_.layout().fluents();
  cost_.assign(nodes.size(), kDeadEnd);
  supporter_.assign(nodes.size(), kNone);
  missing_.resize(nodes.size());
  queue_.clear();
  steps_.clear();
  std::vector<std::uint64_t> sum(nodes.size(), 0);
  for (Index n = 0; n < nodes.size(); ++n) {
    missing_[n] = static_cast<Index>(nodes[n].children.size());
    if (nodes[n].kind == Relaxation::Node::Kind::All && nodes[n].children.empty())
      settle(n, 0, kNone);
  }
  for (Index i = 0; i < fluents.size(); ++i)
    settle(relaxation_.facts().fact(i, fluents[i].get(state)), 0, kNone);
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    const auto [cost, node] = queue_.back();
    queue_.pop_back();
    if (cost != cost_[node]) continue;
    if (node == goal_) break;
    for (const Index p : parents_[node]) {
      if (nodes[p].kind == Relaxation::Node::Kind::Any) {
        settle(p, cost, node);
      } else {
        sum[p] = std::min(sum[p] + cost, kLargest);
        if (--missing_[p] == 0) settle(p, sum[p], kNone);
      }
    }
    for (const Index o : achieves_[node]) {
      const Relaxation::Operator& op = relaxation_.operators()[o];
      const std::uint64_t step_cost = cost_of(op.step);
      for (const FactId f : op.adds) settle(f, std::min(cost + step_cost, kLargest), o);
    }
  }
  if (cost_[goal_] == kDeadEnd) return kDeadEnd;
  // Put the plan together from the goal; each action counts once.
  std::vector<Index> todo = {goal_};
  std::vector<char> seen(nodes.size(), 0);
  seen[goal_] = 1;
  const auto want = [&](Index n) {
    if (seen[n]) return;
    seen[n] = 1;
    todo.push_back(n);
  };
  while (!todo.empty()) {
    const Index n = todo.back();
    todo.pop_back();
    switch (nodes[n].kind) {
      case Relaxation::Node::Kind::Fact:
        if (supporter_[n] != kNone) {
          steps_.push_back(relaxation_.operators()[supporter_[n]].step);
          want(relaxation_.operators()[supporter_[n]].node);
        }
        break;
      case Relaxation::Node::Kind::Any:
        want(supporter_[n]);
        break;
      case Relaxation::Node::Kind::All:
        for (const Index c : nodes[n].children) want(c);
        break;
    }
  }
  std::sort(steps_.begin(), steps_.end());
  steps_.erase(std::unique(steps_.begin(), steps_.end()), steps_.end());
  std::uint64_t total = 0;
  for (const OperatorId s : steps_) total += cost_of(s);
  return total;
}

}  // namespace kaboum::plan
