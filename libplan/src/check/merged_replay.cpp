// Replay of a plan over its nodes, each after all that lead to it.
#include "check/merged_replay.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

bool is_monotone(const Query& q) {
  using K = Query::Kind;
  switch (q.kind) {
    case K::Not:
      return q.children[0].kind == K::Same;
    case K::Xor:
    case K::Derived:
    case K::External:
    case K::Let:
      return false;
    default:
      return std::all_of(q.children.begin(), q.children.end(), is_monotone);
  }
}

bool is_monotone(const Effect& e) {
  if (e.kind == Effect::Kind::Update) {
    const Update& u = e.update;
    const bool observes = u.add && (u.database == Update::Database::Kx ||
                                    (u.literals[0].function && u.literals[0].negated));
    return !observes && !(u.literals[0].value && u.literals[0].value->term);
  }
  if (e.kind == Effect::Kind::When && !e.of_world) return false;
  return std::all_of(e.children.begin(), e.children.end(),
                     [](const Effect& c) { return is_monotone(c); });
}

}  // namespace

bool MergedReplay::takes(const Model& model) {
  return model.externals.empty() && is_monotone(model.goal) &&
         std::all_of(model.actions.begin(), model.actions.end(), [](const Action& a) {
           return is_monotone(a.precondition) &&
                  std::all_of(a.effects.begin(), a.effects.end(),
                              [](const Effect& e) { return is_monotone(e); });
         });
}

/// Nodes before those that they lead to.
std::vector<Index> MergedReplay::order() const {
  std::vector<Index> done;
  std::vector<char> seen(plan_.nodes.size(), 0);
  std::vector<std::pair<Index, bool>> todo = {{plan_.root, false}};
  while (!todo.empty()) {
    const auto [n, left] = todo.back();
    todo.pop_back();
    if (n == kNone) continue;
    if (left) done.push_back(n);
    if (seen[n] != 0) continue;
    seen[n] = 1;
    todo.emplace_back(n, true);
    const Plan::Node& node = plan_.nodes[n];
    if (!node.branches) todo.emplace_back(node.next, false);
    for (const Plan::Branch::Case& c : node.branch.cases) todo.emplace_back(c.next, false);
  }
  std::reverse(done.begin(), done.end());
  return done;
}

void MergedReplay::arrive(Index node, RuntimeKnowledge k) {
  const auto at = arrived_.find(node);
  if (at == arrived_.end())
    arrived_.emplace(node, std::move(k));
  else
    at->second.weaken_to(k, entries_);
}

bool MergedReplay::confirms() {
  for (RuntimeKnowledge& k : transitions_.initial_states()) {
    for (const auto& [entry, open] : k.exclusive()) entries_.insert(entry);
    arrive(plan_.root, std::move(k));
  }
  for (const Index n : order()) {
    const auto at = arrived_.find(n);
    if (at == arrived_.end()) continue;  // no run comes here
    RuntimeKnowledge k = std::move(at->second);
    arrived_.erase(at);
    if (!live_.at(n).all) k.restrict_to(live_.at(n).facts);
    if (!carry_out(n, k)) return false;
  }
  const auto end = arrived_.find(kNone);
  std::vector<Index> slots(std::max<Index>(model_.goal_slots, 1), 0);
  return end != arrived_.end() && evaluator_.holds(model_.goal, slots, end->second);
}

bool MergedReplay::carry_out(Index n, const RuntimeKnowledge& k) {
  const Plan::Node& node = plan_.nodes[n];
  std::vector<RuntimeKnowledge> after = {k};
  if (node.acts) {
    const Action& a = model_.actions[node.action.schema];
    std::vector<Index> slots = bind(a, node.action);
    if (!evaluator_.holds(a.precondition, slots, k)) return false;
    after = transitions_.after(a, slots, k);
    if (after.empty()) return false;  // what it observes contradicts what is known
  }
  for (RuntimeKnowledge& then : after) {
    if (!node.branches)
      arrive(node.next, std::move(then));
    else if (!follow(node.branch, std::move(then)))
      return false;
  }
  return true;
}

bool MergedReplay::follow(const Plan::Branch& branch, RuntimeKnowledge k) {
  const Fact f = branch_fact(branch);
  const Index* value = branch.function ? k.value(f) : nullptr;
  if (branch.function ? value == nullptr : !k.knows_whether(f)) return false;
  const Index sensed = branch.function ? *value : k.knows(f, true) ? 1 : 0;
  for (const Plan::Branch::Case& c : branch.cases)
    if (c.value == sensed) {
      arrive(c.next, std::move(k));
      return true;
    }
  return false;
}

}  // namespace kaboum::plan
