// Synthesis of mutual exclusion invariants [helmert2009concise]; proof of use:
// docs/planning/search.md.
#include "search/invariants.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>
#include <tuple>

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumCandidates = 300;
constexpr std::size_t kMaximumParts = 4;

}  // namespace

Index Invariants::key_of(const Part& p, FactId f) const {
  const Fluent& fluent = task_.layout().fluents()[relaxation_.facts().fluent_of(f)];
  if (fluent.function != p.function || fluent.symbol != p.symbol || fluent.handle) return kNone;
  const Word content = relaxation_.facts().content_of(f);
  if (p.function ? content < kFirstValue : content != static_cast<Word>(AtomKnowledge::True))
    return kNone;
  if (p.key == kNone) return static_cast<Index>(task_.model().objects.size());
  if (p.key < fluent.arguments.size()) return fluent.arguments[p.key];
  return task_.model().types[fluent.range].objects[content - kFirstValue];
}

Index Invariants::key_of(const Candidate& c, FactId f) const {
  for (const Part& p : c) {
    const Index k = key_of(p, f);
    if (k != kNone) return k;
  }
  return kNone;
}

/// Whether the operator, when it happens, certainly ends `f`, a fact among its conditions.
bool Invariants::deletes(Index op, FactId f) const {
  const auto& operators = relaxation_.operators();
  const auto [first, last] = actions_[action_of_[op]];
  for (Index o = first; o < last; ++o) {
    if (o != op && !unconditional_[o]) continue;
    if (relaxation_.ends(operators[o], f)) return true;
  }
  return false;
}

/// Conditions that name two facts of one group, or two contents of one fluent, never hold together.
/// Only a group that starts with at most one fact is one of which that is being proved.
bool Invariants::can_fire(const Candidate& c, const std::vector<FactId>& conditions) const {
  std::vector<Index> keys;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    if (i > 0 && conditions[i] != conditions[i - 1] &&
        relaxation_.facts().fluent_of(conditions[i]) ==
            relaxation_.facts().fluent_of(conditions[i - 1]))
      return false;
    if (i > 0 && conditions[i] == conditions[i - 1]) continue;
    const Index k = key_of(c, conditions[i]);
    if (k == kNone || heavy_[k]) continue;
    if (std::find(keys.begin(), keys.end(), k) != keys.end()) return false;
    keys.push_back(k);
  }
  return true;
}

bool Invariants::balanced(const Candidate& c, Failure& failure) {
  std::fill(heavy_.begin(), heavy_.end(), 0);
  std::vector<char> some(heavy_.size(), 0);
  for (Index i = 0; i < task_.layout().fluents().size(); ++i) {
    const Index k = key_of(
        c, relaxation_.facts().fact(i, task_.layout().fluents()[i].get(task_.initial().data())));
    if (k == kNone) continue;
    heavy_[k] |= some[k];
    some[k] = 1;
  }
  const auto& operators = relaxation_.operators();
  struct Added {
    Index key;
    FactId fact;
    Index op;
  };
  std::vector<Added> added;
  for (const auto& [first, last] : actions_) {
    added.clear();
    limits_.work();
    for (Index o = first; o < last; ++o)
      for (const FactId f : operators[o].adds) {
        const Index k = key_of(c, f);
        if (k != kNone && !heavy_[k]) added.push_back({k, f, o});
      }
    if (added.empty()) continue;
    std::sort(added.begin(), added.end(), [](const Added& a, const Added& b) {
      return std::tie(a.key, a.fact, a.op) < std::tie(b.key, b.fact, b.op);
    });
    for (std::size_t i = 0; i < added.size(); ++i) {
      const Added& a = added[i];
      const std::vector<FactId>& conditions = operators[a.op].preconditions;
      if (!can_fire(c, conditions)) continue;
      // Nothing is added if the fact held and stays.
      const bool held = std::binary_search(conditions.begin(), conditions.end(), a.fact);
      bool paid = held;
      for (const FactId q : conditions)
        paid = paid || (q != a.fact && key_of(c, q) == a.key && deletes(a.op, q));
      if (!paid) {
        failure = {false, a.op, a.fact, a.key};
        return false;
      }
      for (std::size_t j = i + 1; j < added.size() && added[j].key == a.key; ++j) {
        if (added[j].fact == a.fact) continue;
        std::vector<FactId> both;
        std::set_union(conditions.begin(), conditions.end(),
                       operators[added[j].op].preconditions.begin(),
                       operators[added[j].op].preconditions.end(), std::back_inserter(both));
        if (!can_fire(c, both)) continue;
        failure = {true, a.op, a.fact, a.key};
        return false;
      }
    }
  }
  return true;
}

Invariants::Invariants(const Task& task, const Relaxation& relaxation, Limits& limits)
    : task_(task), relaxation_(relaxation), limits_(limits) {
  const auto& operators = relaxation.operators();
  groups_of_.resize(relaxation.facts().size());
  heavy_.assign(task.model().objects.size() + 1, 0);
  unconditional_.assign(operators.size(), 0);
  action_of_.resize(operators.size());
  for (Index o = 0; o < operators.size(); ++o) {
    if (o == 0 || operators[o].step != operators[o - 1].step) actions_.emplace_back(o, o);
    actions_.back().second = o + 1;
    action_of_[o] = static_cast<Index>(actions_.size() - 1);
    if (!task.is_outcome(operators[o].step))
      unconditional_[o] =
          task.action(operators[o].step).effects[operators[o].conditional].condition == kTrue ? 1
                                                                                              : 0;
  }

  std::set<Part> parts;
  for (const Fluent& f : task.layout().fluents()) {
    const auto arguments = static_cast<Index>(f.arguments.size());
    for (Index k = 0; k < arguments + (f.function ? 1 : 0); ++k)
      parts.insert({f.function, f.symbol, k});
    parts.insert({f.function, f.symbol, kNone});
  }
  std::deque<Candidate> open;
  std::set<Candidate> seen;
  for (const Part& p : parts) {
    open.push_back({p});
    seen.insert({p});
  }
  std::size_t tried = 0;
  while (!open.empty() && tried++ < kMaximumCandidates) {
    const Candidate c = open.front();
    open.pop_front();
    Failure failure;
    if (balanced(c, failure)) {
      // One group for each key that starts with at most one of its facts.
      std::map<Index, std::vector<FactId>> members;
      for (FactId f = 0; f < relaxation.facts().size(); ++f) {
        const Index k = key_of(c, f);
        if (k == kNone) continue;
        members[k].push_back(f);
      }
      for (const auto& [k, facts] : members) {
        if (heavy_[k] || facts.size() < 2) continue;
        for (const FactId f : facts) groups_of_[f].push_back(static_cast<Index>(groups_));
        ++groups_;
      }
      continue;
    }
    if (failure.too_heavy || c.size() >= kMaximumParts) continue;
    for (const FactId q : operators[failure.op].preconditions) {
      if (!deletes(failure.op, q)) continue;
      for (const Part& p : parts) {
        if (key_of(p, q) != failure.key) continue;
        if (std::any_of(c.begin(), c.end(), [&](const Part& x) {
              return x.function == p.function && x.symbol == p.symbol;
            }))
          continue;
        Candidate larger = c;
        larger.push_back(p);
        std::sort(larger.begin(), larger.end());
        if (seen.insert(larger).second) open.push_back(std::move(larger));
      }
    }
  }
}

bool Invariants::exclusive(FactId a, FactId b) const {
  if (a == b) return false;
  if (relaxation_.facts().fluent_of(a) == relaxation_.facts().fluent_of(b)) return true;
  const auto& x = groups_of_[a];
  const auto& y = groups_of_[b];
  for (std::size_t i = 0, j = 0; i < x.size() && j < y.size();) {
    if (x[i] == y[j]) return true;
    if (x[i] < y[j]) {
      ++i;
    } else {
      ++j;
    }
  }
  return false;
}

}  // namespace kaboum::plan
