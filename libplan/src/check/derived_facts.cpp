// Least fixed points by rounds: an atom that is being looked at counts as false until a round finds
// that it holds. A round that finds nothing more has looked at a fixed point, and all that was
// found has a derivation.
#include "check/derived_facts.h"

#include <kaboum/base/error.h>

#include <algorithm>

namespace kaboum::plan {
namespace {

// Rules within one another, counted by how deep their conditions are: calls are nested as deeply.
// What lies deeper than the first waits for the next round.
constexpr int kDeepInRound = 1500;
constexpr int kDeepest = 2500;
constexpr int kOfARule = 2;  ///< for the calls between its head and its condition

int depth_of(const Query& q) {
  int most = 0;
  for (const Query& c : q.children) most = std::max(most, depth_of(c));
  return most + 1;
}

}  // namespace

DerivedFacts::DerivedFacts(const Model& model, const QueryEvaluator& evaluator,
                           const RuntimeKnowledge& k)
    : model_(model), evaluator_(evaluator), k_(k) {
  for (const Rule& r : model.rules) body_depth_.push_back(depth_of(r.body));
}

bool DerivedFacts::holds(const Fact& atom) {
  if (const auto known = decided_.find(atom); known != decided_.end()) return known->second;
  const Symbol& predicate = model_.predicates[atom[1]];
  if (const auto round = rounds_.find(predicate.level); round != rounds_.end())
    return look(atom, round->second);
  if (depth_ > kDeepest)
    throw Error(ErrorCode::LimitReached, "too many derived predicates rest on one another");
  const bool truth = predicate.recursive ? decide(atom) : by_rules(atom);
  decided_[atom] = truth;
  return truth;
}

bool DerivedFacts::decide(const Fact& atom) {
  const Index level = model_.predicates[atom[1]].level;
  Round& round = rounds_[level];
  round.roots = {atom};
  do {
    round.looked.clear();
    round.more = false;
    for (std::size_t i = round.roots.size(); i > 0; --i) look(Fact(round.roots[i - 1]), round);
  } while (round.more);
  for (const auto& [a, truth] : round.looked) decided_[a] = truth;
  rounds_.erase(level);
  return found_.contains(atom);
}

bool DerivedFacts::look(const Fact& atom, Round& round) {
  if (found_.contains(atom)) return true;
  if (depth_ > kDeepInRound && std::ranges::find(round.roots, atom) == round.roots.end()) {
    round.roots.push_back(atom);
    round.more = true;
    return false;
  }
  const auto [at, fresh] = round.looked.try_emplace(atom, false);
  if (!fresh) return at->second;
  if (by_rules(atom)) {
    found_.insert(atom);
    round.more = true;
    at->second = true;
  }
  return at->second;
}

bool DerivedFacts::by_rules(const Fact& atom) {
  bool truth = false;
  for (std::size_t n = 0; n < model_.rules.size(); ++n) {
    const Rule& r = model_.rules[n];
    if (truth || r.predicate != atom[1]) continue;
    const int deeper = kOfARule + body_depth_[n];
    depth_ += deeper;
    std::vector<Index> slots(std::max<Index>(r.slots, 1), 0);
    bool fits = true;
    for (std::size_t i = 0; i < r.parameters.size(); ++i) {
      slots[i] = atom[i + 2];
      fits = fits && model_.is_a(slots[i], r.parameters[i]);
    }
    truth = fits && evaluator_.holds(r.body, slots, k_);
    depth_ -= deeper;
  }
  return truth;
}

}  // namespace kaboum::plan
