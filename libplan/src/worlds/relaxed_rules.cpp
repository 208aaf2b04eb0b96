// Delete relaxation over plain propositions: additive costs, cheapest supporters.
#include "worlds/relaxed_rules.h"

#include <algorithm>

namespace kaboum::plan::worlds {

void RelaxedRules::Lists::append(const std::vector<Index>& list) {
  elements.insert(elements.end(), list.begin(), list.end());
  begins.push_back(static_cast<Index>(elements.size()));
}

Index RelaxedRules::propositions(Index count) {
  const Index first = propositions_;
  propositions_ += count;
  return first;
}

std::size_t RelaxedRules::bytes() const {
  const auto of = [](const Lists& l) { return l.begins.size() + l.elements.size(); };
  return (of(needs_) + of(adds_) + kinds_.size() + propositions_) * sizeof(Index);
}

void RelaxedRules::add(std::vector<Index> needs, const std::vector<Index>& adds, Cost cost) {
  std::sort(needs.begin(), needs.end());
  needs.erase(std::unique(needs.begin(), needs.end()), needs.end());
  kinds_.push_back(cost);
  need_counts_.push_back(static_cast<Index>(needs.size()));
  own_costs_.push_back(cost == Cost::Step ? 1 : 0);
  needs_.append(needs);
  adds_.append(adds);
}

void RelaxedRules::prepare() {
  std::vector<std::vector<Index>> rules(propositions_);
  for (Index r = 0; r < kinds_.size(); ++r)
    for (Index i = needs_.begins[r]; i < needs_.begins[r + 1]; ++i)
      rules[needs_.elements[i]].push_back(r);
  for (const auto& list : rules) needed_by_.append(list);
  supporters_.resize(propositions_);
}

void RelaxedRules::set_cost(Index proposition, int cost, Index by) {
  if (cost >= costs_[proposition]) return;
  costs_[proposition] = cost;
  supporters_[proposition] = by;
  if (buckets_.size() <= static_cast<std::size_t>(cost)) buckets_.resize(cost + 1);
  buckets_[cost].push_back(proposition);
}

void RelaxedRules::apply(Index rule) {
  for (Index i = adds_.begins[rule]; i < adds_.begins[rule + 1]; ++i)
    set_cost(adds_.elements[i], rule_costs_[rule], rule);
}

/// Propositions in the order of their costs, until the wanted one.
bool RelaxedRules::reach(Index wanted) {
  for (std::size_t b = 0; b < buckets_.size(); ++b)
    for (std::size_t i = 0; i < buckets_[b].size(); ++i) {
      const Index p = buckets_[b][i];
      const int cost = costs_[p];
      if (cost != static_cast<int>(b)) continue;
      if (p == wanted) return true;
      for (Index k = needed_by_.begins[p]; k < needed_by_.begins[p + 1]; ++k) {
        const Index r = needed_by_.elements[k];
        const bool highest = kinds_[r] == Cost::Highest;
        rule_costs_[r] = highest ? cost : std::min(rule_costs_[r] + cost, kMostCost);
        if (--missing_[r] == 0) apply(r);
      }
    }
  return false;
}

int RelaxedRules::plan(const std::vector<Index>& holding, Index wanted) {
  if (supporters_.empty()) prepare();
  costs_.assign(propositions_, kUnreached);
  rule_costs_ = own_costs_;
  missing_ = need_counts_;
  for (auto& b : buckets_) b.clear();
  for (const Index p : holding) set_cost(p, 0, kNone);
  for (Index r = 0; r < kinds_.size(); ++r)
    if (need_counts_[r] == 0) apply(r);
  return reach(wanted) ? count_steps(wanted) : kUnreached;
}

int RelaxedRules::count_steps(Index wanted) {
  marked_.assign(propositions_, 0);
  counted_.assign(kinds_.size(), 0);
  int count = 0;
  std::vector<Index> todo = {wanted};
  while (!todo.empty()) {
    const Index p = todo.back();
    todo.pop_back();
    if (marked_[p] != 0 || supporters_[p] == kNone) continue;
    marked_[p] = 1;
    const Index r = supporters_[p];
    if (counted_[r] != 0) continue;
    counted_[r] = 1;
    count += own_costs_[r];
    todo.insert(todo.end(), needs_.elements.begin() + needs_.begins[r],
                needs_.elements.begin() + needs_.begins[r + 1]);
  }
  return count;
}

}  // namespace kaboum::plan::worlds
