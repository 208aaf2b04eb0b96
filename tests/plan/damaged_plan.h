#pragma once

#include <kaboum/plan/plan.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "possible_worlds.h"

namespace kaboum::plan::test {

/// What the validator should say, by sets of worlds: every precondition, branch and end.
inline bool valid_in_worlds(const Model& m, const Plan& p) {
  const Worlds worlds(m);
  std::set<std::pair<Index, Belief>> seen;
  std::vector<std::pair<Index, Belief>> todo;
  std::set<Index> contradicted, passed;
  const auto visit = [&](Index n, const Belief& b) {
    if (seen.emplace(n, b).second) todo.emplace_back(n, b);
  };
  for (const Belief& b : worlds.initial()) visit(p.root, b);
  while (!todo.empty()) {
    const auto [n, belief] = todo.back();
    todo.pop_back();
    if (n == kNone) {
      std::vector<Index> slots(std::max<Index>(m.goal_slots, 1), 0);
      if (!worlds.holds(m.goal, slots, belief)) return false;
      continue;
    }
    const Plan::Node& node = p.nodes[n];
    std::vector<Belief> after = {belief};
    if (node.acts) {
      const Action& a = m.actions[node.action.schema];
      std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
      std::copy(node.action.arguments.begin(), node.action.arguments.end(), slots.begin());
      if (!worlds.holds(a.precondition, slots, belief)) return false;
      after = worlds.apply(belief, worlds.fired(a, node.action.arguments, belief));
      (after.empty() ? contradicted : passed).insert(n);
    }
    for (const Belief& b : after) {
      if (!node.branches) {
        visit(node.next, b);
        continue;
      }
      const std::size_t item =
          worlds.number(node.branch.function, node.branch.symbol, node.branch.arguments);
      const Index value = (*b.begin())[item];
      for (const World& w : b)
        if (w[item] != value) return false;
      bool found = false;
      for (const Plan::Branch::Case& c : node.branch.cases) {
        if (c.value != value || found) continue;
        found = true;
        visit(c.next, b);
      }
      if (!found) return false;
    }
  }
  return std::all_of(contradicted.begin(), contradicted.end(),
                     [&](Index n) { return passed.contains(n); });
}

/// A plan with some of its successors, arguments, actions or cases exchanged or lost; it may work
/// all the same, or have a cycle.
inline Plan damaged(const Model& m, const Plan& plan, std::size_t edits, std::mt19937& random) {
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  Plan p = plan;
  for (; edits > 0; --edits) {
    Plan::Node& n = p.nodes[pick(p.nodes.size())];
    const auto anywhere = [&] {
      return pick(3) == 0 ? kNone : static_cast<Index>(pick(p.nodes.size()));
    };
    switch (pick(8)) {
      case 0:  // another successor
        (n.branches ? n.branch.cases[pick(n.branch.cases.size())].next : n.next) = anywhere();
        break;
      case 1:  // another argument
        if (!n.action.arguments.empty())
          n.action.arguments[pick(n.action.arguments.size())] = static_cast<Index>(pick(3));
        break;
      case 2: {  // another action
        if (!n.acts) break;
        n.action.schema = static_cast<Index>(pick(m.actions.size()));
        n.action.arguments.assign(m.actions[n.action.schema].parameters.size(),
                                  static_cast<Index>(pick(3)));
        break;
      }
      case 3:  // exchanged actions
        std::swap(n.action, p.nodes[pick(p.nodes.size())].action);
        break;
      case 4:  // a case lost
        if (n.branches && n.branch.cases.size() > 1)
          n.branch.cases.erase(n.branch.cases.begin() +
                               static_cast<std::ptrdiff_t>(pick(n.branch.cases.size())));
        break;
      case 5:  // cases exchanged
        if (n.branches) std::swap(n.branch.cases.front().next, n.branch.cases.back().next);
        break;
      case 6:  // the action, or the branch, forgotten
        if (n.acts && n.branches) {
          n.acts = pick(2) != 0;
          n.branches = !n.acts;
          if (!n.branches) n.next = n.branch.cases.front().next;
        }
        break;
      default:  // another start
        p.root = anywhere();
    }
  }
  for (Plan::Node& n : p.nodes)
    if (n.acts && n.action.arguments.size() != m.actions[n.action.schema].parameters.size())
      n.action.arguments.assign(m.actions[n.action.schema].parameters.size(), 0);
  return p;
}

}  // namespace kaboum::plan::test
