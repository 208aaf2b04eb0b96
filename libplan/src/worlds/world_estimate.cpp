// Relaxed plans of single worlds: additive costs, cheapest supporters.
#include "worlds/world_estimate.h"

#include <algorithm>

#include "task/knowledge.h"
#include "worlds/alternatives.h"

namespace kaboum::plan::worlds {
namespace {

constexpr int kFar = WorldEstimate::kDead;

}  // namespace

WorldEstimate::WorldEstimate(const BeliefSpace& space) : space_(space) {
  const WorldTask& task = space.task();
  Index facts = 0;
  for (const Variable& v : task.variables) {
    base_.push_back(facts);
    facts += v.size;
  }
  for (Index o = 0; o < task.operators.size(); ++o) add_unary(task.operators[o], o);
  needed_by_.resize(facts);
  for (Index u = 0; u < unary_.size(); ++u) {
    for (const Index f : unary_[u].needs) needed_by_[f].push_back(u);
    if (unary_[u].needs.empty()) without_needs_.push_back(u);
  }
  goals_ = needs({&task.goal});
  cost_.resize(facts);
  supporter_.resize(facts);
  marked_.resize(facts);
  missing_.resize(unary_.size());
  unary_cost_.resize(unary_.size());
  chosen_.resize(task.operators.size());
}

/// Sets of facts one of which a world must have for all conditions.
std::vector<std::vector<Index>> WorldEstimate::needs(
    const std::vector<const Condition*>& all) const {
  std::vector<std::vector<Index>> facts;
  for (const auto& literals : alternatives(space_.task(), all)) {
    facts.emplace_back();
    for (const auto& [variable, value] : literals) facts.back().push_back(fact(variable, value));
  }
  return facts;
}

void WorldEstimate::add_unary(const Operator& o, Index number) {
  const WorldTask& task = space_.task();
  for (const Step& s : o.steps) {
    observes_ |= s.kind == Step::Kind::Rule || s.kind == Step::Kind::OneOf;
    std::vector<Index> adds;
    if (s.kind == Step::Kind::Set) adds = {fact(s.variable, s.value)};
    if (s.kind == Step::Kind::Free || s.kind == Step::Kind::Rule || s.kind == Step::Kind::OneOf)
      for (Index v = 0; v < task.variables[s.variable].size; ++v)
        adds.push_back(fact(s.variable, v));
    if (adds.empty()) continue;
    for (std::vector<Index>& n : needs({&o.precondition, &s.known, &s.world})) {
      if (!unary_.empty() && unary_.back().group == number && unary_.back().needs == n) {
        unary_.back().adds.insert(unary_.back().adds.end(), adds.begin(), adds.end());
      } else {
        unary_.push_back({std::move(n), adds, number});
      }
    }
  }
}

int WorldEstimate::operator()(const Word* belief) {
  const WorldTask& task = space_.task();
  std::size_t samples = 1;
  for (Index c = 0; c < task.components.size(); ++c)
    samples =
        std::max<std::size_t>(samples, space_.sets(c).members(space_.set_of(c, belief)).count);
  samples = std::min(samples, kSamples);
  std::uint64_t common = 0;
  for (Index i = 0; i < task.common_words; ++i) common ^= word_hash(i, belief[i]);
  int worst = 0;
  std::vector<const Word*> worlds(task.components.size());
  std::vector<Index> state(task.variables.size());
  for (std::size_t i = 0; i < samples; ++i) {
    std::uint64_t key = common;
    for (Index c = 0; c < worlds.size(); ++c) {
      const WorldSets::Members m = space_.sets(c).members(space_.set_of(c, belief));
      const Index w = m.first[m.count <= samples ? i % m.count : i * m.count / samples];
      worlds[c] = space_.sets(c).contents(w);
      key ^= word_hash(task.common_words + c, w);
    }
    const auto [it, fresh] = known_.emplace(key, 0);
    if (fresh) {
      for (Index v = 0; v < state.size(); ++v) {
        const Variable& variable = task.variables[v];
        state[v] = variable.get(variable.hidden ? worlds[variable.component] : belief);
      }
      it->second = relaxed_plan(state);
    }
    worst = std::max(worst, it->second);
  }
  return worst >= kFar && observes_ ? kFar / 2 : worst;
}

int WorldEstimate::relaxed_plan(const std::vector<Index>& state) {
  std::fill(cost_.begin(), cost_.end(), kFar);
  std::fill(supporter_.begin(), supporter_.end(), kNone);
  std::fill(unary_cost_.begin(), unary_cost_.end(), 1);
  for (Index u = 0; u < unary_.size(); ++u)
    missing_[u] = static_cast<Index>(unary_[u].needs.size());
  for (auto& b : buckets_) b.clear();
  const auto reach = [&](Index f, int cost, Index by) {
    if (cost >= cost_[f]) return;
    cost_[f] = cost;
    supporter_[f] = by;
    if (buckets_.size() <= static_cast<std::size_t>(cost)) buckets_.resize(cost + 1);
    buckets_[cost].push_back(f);
  };
  for (Index v = 0; v < state.size(); ++v) reach(fact(v, state[v]), 0, kNone);
  for (const Index u : without_needs_)
    for (const Index f : unary_[u].adds) reach(f, 1, u);
  constexpr int kMostCost = 100'000;
  for (std::size_t b = 0; b < buckets_.size() && b < kMostCost; ++b)
    for (std::size_t i = 0; i < buckets_[b].size(); ++i) {
      const Index f = buckets_[b][i];
      if (cost_[f] != static_cast<int>(b)) continue;
      for (const Index u : needed_by_[f]) {
        unary_cost_[u] = std::min(unary_cost_[u] + cost_[f], kMostCost - 1);
        if (--missing_[u] > 0) continue;
        for (const Index added : unary_[u].adds) reach(added, unary_cost_[u], u);
      }
    }
  // The cheapest alternative of the goal.
  const std::vector<Index>* goal = nullptr;
  long best = kFar;
  for (const std::vector<Index>& g : goals_) {
    long sum = 0;
    for (const Index f : g) sum += cost_[f];
    if (sum < best) {
      best = sum;
      goal = &g;
    }
  }
  if (goal == nullptr) return kFar;
  std::fill(marked_.begin(), marked_.end(), 0);
  std::fill(chosen_.begin(), chosen_.end(), 0);
  std::vector<Index> todo = *goal;
  int steps = 0;
  while (!todo.empty()) {
    const Index f = todo.back();
    todo.pop_back();
    if (marked_[f] != 0 || supporter_[f] == kNone) continue;
    marked_[f] = 1;
    const Unary& u = unary_[supporter_[f]];
    if (chosen_[u.group] == 0) {
      chosen_[u.group] = 1;
      ++steps;
    }
    todo.insert(todo.end(), u.needs.begin(), u.needs.end());
  }
  return steps;
}

}  // namespace kaboum::plan::worlds
