// The delete relaxation: reachable facts and operators, and their and-or graph.
#include "search/relaxation.h"

#include <algorithm>
#include <iterator>

namespace kaboum::plan {

using Kind = FormulaPool::Kind;

Relaxation::Relaxation(Task& task, Limits& limits)
    : task_(task),
      limits_(limits),
      facts_(task.model(), task.layout()),
      reachability_(task, limits, facts_) {
  nodes_.resize(facts_.size());
  for (const OperatorId a : actions()) add_action(a);
  for (Index i = 0; i < task.layout().fluents().size(); ++i) {
    const Fluent& f = task.layout().fluents()[i];
    const FactId sensed =
        facts_.fact(i, f.function ? kValueSensed : static_cast<Word>(AtomKnowledge::Whether));
    if (!reachability_.reached(sensed)) continue;
    for (Index v = 0; v < (f.function ? task.layout().range_size(f) : 2); ++v) {
      Operator o;
      o.step = task.outcome_id(i, v);
      o.preconditions = {sensed};
      o.adds = {facts_.fact(
          i, f.function ? kFirstValue + v
                        : static_cast<Word>(v == 1 ? AtomKnowledge::True : AtomKnowledge::False))};
      add_operator(std::move(o), {sensed});
    }
  }
  // Kx and exclusions may decide or sense without an action that says so: free, to be safe.
  for (Index i = 0; i < task.layout().fluents().size(); ++i) {
    const Fluent& f = task.layout().fluents()[i];
    if (f.groups.empty() && f.exclusions == kNone) continue;
    Operator o;
    o.step = task.outcome_id(i, 0);
    const Word contents = f.function ? task.layout().range_size(f) + kFirstValue : 4;
    for (Word c = 1; c < contents; ++c)
      if (!f.function || c != kValueSensed) o.adds.push_back(facts_.fact(i, c));
    add_operator(std::move(o), {});
  }
  node(task.goal());
}

Index Relaxation::node(Formula f, bool positive) {
  const Index made = make_node(f, positive);
  // Not within one another: chains of rules may be long, and come back to where they began.
  while (!pending_.empty()) {
    const auto [at, body, holds] = pending_.back();
    pending_.pop_back();
    const Index child = make_node(body, holds);
    nodes_[at].children = {child};
  }
  return made;
}

Index Relaxation::make_node(Formula f, bool positive) {
  const std::uint64_t key = (std::uint64_t{f} << 1U) | (positive ? 1U : 0U);
  if (const auto known = node_index_.find(key); known != node_index_.end()) return known->second;
  const FormulaPool& pool = task_.pool();
  const FormulaPool::Node n = pool.node(f);
  Node made;
  switch (n.kind) {
    case Kind::True:
    case Kind::False:
      made.kind = (n.kind == Kind::True) == positive ? Node::Kind::All : Node::Kind::Any;
      break;
    case Kind::Not: {
      const Index child = make_node(*pool.begin(f), !positive);
      node_index_[key] = child;
      return child;
    }
    case Kind::And:
    case Kind::Or:
      made.kind = (n.kind == Kind::And) == positive ? Node::Kind::All : Node::Kind::Any;
      for (const Formula* c = pool.begin(f); c != pool.end(f); ++c)
        made.children.push_back(make_node(*c, positive));
      break;
    case Kind::Xor:
      made.kind = positive ? Node::Kind::Any : Node::Kind::All;
      if (positive)
        for (const Formula* c = pool.begin(f); c != pool.end(f); ++c)
          made.children.push_back(make_node(*c, true));
      break;
    case Kind::Bits:
    case Kind::External:
      made.kind = Node::Kind::All;  // optimistic; calling is left to the search
      break;
    case Kind::Derived:
      // What its rules need costs nothing more. Of a recursive one the negation is taken for true:
      // its rules' negations may need one another.
      made.kind = Node::Kind::All;
      if (!positive && task_.derived().recursive(n.a)) break;
      made.kind = Node::Kind::Any;
      pending_.push_back({static_cast<Index>(nodes_.size()), task_.derived().body(n.a), positive});
      break;
    default: {
      bool always = false;
      std::vector<FactId> any = facts_.leaf_contents(n, positive, always);
      made.kind = Node::Kind::Any;
      if (always) made.kind = Node::Kind::All;
      if (!always) {
        std::erase_if(any, [&](FactId x) { return !reachability_.reached(x); });
        if (any.size() == 1) {
          node_index_[key] = any[0];
          return any[0];
        }
        made.children.assign(any.begin(), any.end());
      }
    }
  }
  const auto index = static_cast<Index>(nodes_.size());
  limits_.work(sizeof(Node) + made.children.size() * sizeof(Index) + 32);
  nodes_.push_back(std::move(made));
  node_index_[key] = index;
  return index;
}

std::vector<FactId> Relaxation::necessary_facts(Formula f) const {
  const FormulaPool& pool = task_.pool();
  const FormulaPool::Node& n = pool.node(f);
  std::vector<FactId> result;
  if (n.kind == Kind::And) {
    for (const Formula* c = pool.begin(f); c != pool.end(f); ++c)
      for (const FactId x : necessary_facts(*c)) result.push_back(x);
  } else if (n.kind == Kind::Or) {
    for (const Formula* c = pool.begin(f); c != pool.end(f); ++c) {
      std::vector<FactId> of = necessary_facts(*c), common;
      if (c != pool.begin(f)) {
        std::set_intersection(result.begin(), result.end(), of.begin(), of.end(),
                              std::back_inserter(common));
        of = std::move(common);
      }
      result = std::move(of);
      if (result.empty()) break;
    }
  } else if (n.kind == Kind::IsTrue || n.kind == Kind::IsFalse || n.kind == Kind::ValueIs) {
    bool always = false;
    const std::vector<FactId> any = facts_.leaf_contents(n, true, always);
    if (!always && any.size() == 1) result = any;
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

void Relaxation::add_operator(Operator o, std::vector<Index> conditions) {
  o.node = static_cast<Index>(nodes_.size());
  limits_.work(2 * sizeof(Operator) + sizeof(Node) +
               (conditions.size() + o.preconditions.size() + o.adds.size()) * sizeof(Index));
  nodes_.push_back({Node::Kind::All, std::move(conditions)});
  operators_.push_back(std::move(o));
}

/// Whether the change makes known at run time what was unknown before the action, and does nothing
/// else: no other change of the action concerns the fluent.
bool Relaxation::senses_unknown(const GroundAction& action, const Change& change) const {
  if (change.kind != Change::Kind::AddWhether && change.kind != Change::Kind::AddSensed)
    return false;
  const Fluent& f = task_.layout().fluents()[change.fluent];
  if (!f.groups.empty() || f.exclusions != kNone) return false;
  const auto concerns = [&](const Change& c) { return c.fluent == change.fluent; };
  return std::none_of(
      action.effects.begin(), action.effects.end(), [&](const ConditionalEffect& c) {
        return std::any_of(c.deletions.begin(), c.deletions.end(), concerns) ||
               std::any_of(c.direct.begin(), c.direct.end(), concerns) ||
               std::any_of(c.additions.begin(), c.additions.end(), concerns) ||
               std::any_of(c.transfers.begin(), c.transfers.end(),
                           [&](const auto& t) { return t.fluent == change.fluent; });
      });
}

void Relaxation::add_action(OperatorId step) {
  const GroundAction& a = task_.action(step);
  const Index precondition = node(a.precondition);
  const std::vector<FactId> needed = necessary_facts(a.precondition);
  for (Index i = 0; i < a.effects.size(); ++i) {
    const ConditionalEffect& c = a.effects[i];
    if (!reachability_.possible(c.condition, true)) continue;
    Operator o;
    o.step = step;
    o.cost = a.cost;
    o.conditional = i;
    const std::vector<FactId> condition = necessary_facts(c.condition);
    std::set_union(needed.begin(), needed.end(), condition.begin(), condition.end(),
                   std::back_inserter(o.preconditions));
    std::vector<Index> conditions = {precondition};
    if (c.condition != kTrue) conditions.push_back(node(c.condition));
    o.adds = facts_.added(c);
    for (const Change& change : c.sensing) {
      if (!senses_unknown(a, change)) continue;
      Operator senses = o;
      senses.adds = facts_.added(change);
      std::erase_if(o.adds, [&](FactId f) {
        return std::find(senses.adds.begin(), senses.adds.end(), f) != senses.adds.end();
      });
      const FactId unknown = facts_.fact(change.fluent, 0);
      std::vector<Index> needs = conditions;
      needs.push_back(unknown);
      const auto at =
          std::lower_bound(senses.preconditions.begin(), senses.preconditions.end(), unknown);
      if (at == senses.preconditions.end() || *at != unknown)
        senses.preconditions.insert(at, unknown);
      add_operator(std::move(senses), std::move(needs));
    }
    if (!o.adds.empty()) add_operator(std::move(o), std::move(conditions));
  }
}

}  // namespace kaboum::plan
