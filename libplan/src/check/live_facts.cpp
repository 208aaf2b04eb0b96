// Liveness of facts, from the ends of the plan back to its root.
#include "check/live_facts.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

std::vector<Index> successors(const Plan::Node& node) {
  std::vector<Index> next;
  if (!node.branches) next.push_back(node.next);
  for (const Plan::Branch::Case& c : node.branch.cases) next.push_back(c.next);
  return next;
}

/// Whether it leaves out worlds, by the value of its fact.
bool observes(const Update& u) {
  using D = Update::Database;
  if (!u.add) return false;
  return u.database == D::Kw || u.database == D::Kv || u.database == D::Lcw ||
         (u.database == D::Kf && u.literals[0].function && u.literals[0].negated);
}

}  // namespace

Fact branch_fact(const Plan::Branch& b) {
  Fact f = {b.function ? Index{1} : Index{0}, b.symbol};
  f.insert(f.end(), b.arguments.begin(), b.arguments.end());
  return f;
}

std::vector<Index> bind(const Action& a, const PlanAction& action) {
  std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
  std::copy(action.arguments.begin(), action.arguments.end(), slots.begin());
  return slots;
}

LiveFacts::LiveFacts(const Model& model, const Plan& plan, const QueryEvaluator& evaluator,
                     Sensing sensing)
    : model_(model), evaluator_(evaluator), sensing_(sensing) {
  std::vector<Index> slots(std::max<Index>(model.goal_slots, 1), 0);
  goal_.all = !evaluator.reads(model.goal, slots, goal_.facts);
  by_node_.resize(plan.nodes.size());
  std::vector<char> done(plan.nodes.size(), 0);
  // Acyclic: repeat over a stack until successors are done.
  std::vector<Index> stack;
  if (plan.root != kNone) stack.push_back(plan.root);
  while (!stack.empty()) {
    const Index n = stack.back();
    const std::vector<Index> next = successors(plan.nodes[n]);
    bool ready = true;
    for (const Index m : next)
      if (m != kNone && !done[m]) {
        stack.push_back(m);
        ready = false;
      }
    if (!ready) continue;
    stack.pop_back();
    if (done[n]) continue;
    done[n] = 1;
    read_node(plan.nodes[n], next, by_node_[n]);
  }
}

void LiveFacts::read_node(const Plan::Node& node, const std::vector<Index>& successors,
                          Reads& live) const {
  for (const Index m : successors) {
    const Reads& below = at(m);
    live.facts.insert(below.facts.begin(), below.facts.end());
    live.all |= below.all;
  }
  if (node.branches) live.facts.insert(branch_fact(node.branch));
  if (node.acts) {
    const Action& a = model_.actions[node.action.schema];
    std::vector<Index> bound = bind(a, node.action);
    live.all |= !evaluator_.reads(a.precondition, bound, live.facts);
    for (const Effect& e : a.effects) effect_reads(e, bound, live);
  }
}

void LiveFacts::effect_reads(const Effect& e, std::vector<Index>& slots, Reads& out) const {
  if (e.kind == Effect::Kind::When) out.all |= !evaluator_.reads(e.condition, slots, out.facts);
  if (e.kind == Effect::Kind::Update)
    if (const auto& value = e.update.literals[0].value; value && value->term)
      out.facts.insert(fact(true, value->term->function, value->term->arguments, slots));
  if (sensing_ == Sensing::Reads && e.kind == Effect::Kind::Update && observes(e.update)) {
    const Update::Literal& l = e.update.literals[0];
    out.facts.insert(fact(l.function, l.symbol, l.arguments, slots));
  }
  // A disjunction combines with what is known of its atoms by then.
  if (e.kind == Effect::Kind::Update && e.update.database == Update::Database::Kx)
    for (const Update::Literal& l : e.update.literals)
      out.facts.insert(fact(l.function, l.symbol, l.arguments, slots));
  if (e.kind == Effect::Kind::ForAll) {
    for (const Index o : model_.types[e.type].objects) {
      slots.at(e.slot) = o;
      for (const Effect& c : e.children) effect_reads(c, slots, out);
    }
    return;
  }
  for (const Effect& c : e.children) effect_reads(c, slots, out);
}

}  // namespace kaboum::plan
