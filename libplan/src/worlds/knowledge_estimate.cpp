// Relaxed plans that find out what they need to know: facts are kept for some worlds of each
// component, as are labels in the planning graphs of [bryce2006planning].
#include "worlds/knowledge_estimate.h"

#include <kaboum/base/error.h>

#include <algorithm>

namespace kaboum::plan::worlds {

KnowledgeEstimate::KnowledgeEstimate(const BeliefSpace& space, Limits& limits) : space_(space) {
  const WorldTask& task = space.task();
  for (const Variable& v : task.variables)
    base_.push_back(rules_.propositions(v.size * (v.hidden ? kSample : 1)));
  ruled_out_ = rules_.propositions(static_cast<Index>(task.components.size()) * kSample);
  for (const Operator& o : task.operators) {
    const std::size_t before = rules_.bytes();
    add_operator(o);
    limits.hold(2 * (rules_.bytes() - before));
  }
  add_goal(task.goal);
}

void KnowledgeEstimate::add_goal(const Condition& goal) {
  if (goal.kind == Condition::Kind::And) {
    for (const Condition& child : goal.children) add_goal(child);
    return;
  }
  goals_.emplace_back(&goal, rules_.propositions(1));
  for (const auto& literals : alternatives(space_.task(), goal))
    rules_.add(known(literals), {goals_.back().second}, Cost::Sum);
}

/// It holds in each world of the sample that is not ruled out.
Index KnowledgeEstimate::known(const Literal& l) {
  if (!hidden(l.first)) return in_world(l, 0);
  const auto [at, fresh] = known_.emplace(l, 0);
  if (!fresh) return at->second;
  const Index component = space_.task().variables[l.first].component;
  const Index first = rules_.propositions(kSample + 1);
  std::vector<Index> everywhere;
  for (Index w = 0; w < kSample; ++w) {
    rules_.add({in_world(l, w)}, {first + w}, Cost::Sum);
    if (w > 0) rules_.add({ruled_out(component, w)}, {first + w}, Cost::Sum);
    everywhere.push_back(first + w);
  }
  rules_.add(std::move(everywhere), {first + kSample}, Cost::Highest);
  return at->second = first + kSample;
}

std::vector<Index> KnowledgeEstimate::known(const std::vector<Literal>& all) {
  std::vector<Index> made;
  made.reserve(all.size());
  for (const Literal& l : all) made.push_back(known(l));
  return made;
}

/// Rules out worlds in which the variable has another value than in the first.
Index KnowledgeEstimate::sensed(Index variable) {
  const auto [at, fresh] = sensed_.emplace(variable, 0);
  if (!fresh) return at->second;
  const Variable& v = space_.task().variables[variable];
  const Index made = at->second = rules_.propositions(1);
  for (Index w = 1; w < kSample; ++w) {
    if (v.size > kMostValues) rules_.add({made}, {ruled_out(v.component, w)}, Cost::Sum);
    for (Index here = 0; here < v.size && v.size <= kMostValues; ++here)
      for (Index there = 0; there < v.size; ++there)
        if (here != there)
          rules_.add({made, in_world({variable, here}, 0), in_world({variable, there}, w)},
                     {ruled_out(v.component, w)}, Cost::Sum);
  }
  return made;
}

/// What a step does once it is made.
void KnowledgeEstimate::add_change(const Step& s, Index step) {
  const WorldTask& task = space_.task();
  const bool set = s.kind == Step::Kind::Set;
  std::vector<Literal> literals;
  for (Index v = 0; v < task.variables[s.variable].size; ++v)
    if (!set || v == s.value) literals.emplace_back(s.variable, v);
  for (const auto& there : alternatives(task, {&s.world}))
    for (Index w = 0; w < (hidden(s.variable) ? kSample : 1); ++w) {
      std::vector<Index> needs = {step};
      for (const Literal& l : there) needs.push_back(in_world(l, w));
      std::vector<Index> adds;
      adds.reserve(literals.size());
      for (const Literal& l : literals) adds.push_back(in_world(l, w));
      rules_.add(std::move(needs), adds, Cost::Sum);
    }
}

void KnowledgeEstimate::add_operator(const Operator& o) {
  const WorldTask& task = space_.task();
  const Index step = rules_.propositions(1);
  for (const auto& needed : alternatives(task, {&o.precondition}))
    rules_.add(known(needed), {step}, Cost::Step);
  for (const Step& s : o.steps) {
    // An observation would rule worlds out, for which there are no rules here.
    ensure(s.kind != Step::Kind::Rule && s.kind != Step::Kind::OneOf, "grounding refuses these");
    Index made = step;
    if (s.known.kind != Condition::Kind::True) {
      made = rules_.propositions(1);
      for (const auto& needed : alternatives(task, {&s.known})) {
        std::vector<Index> needs = known(needed);
        needs.push_back(step);
        rules_.add(std::move(needs), {made}, Cost::Sum);
      }
    }
    if (s.kind != Step::Kind::Sense)
      add_change(s, made);
    else if (hidden(s.variable))
      rules_.add({made}, {sensed(s.variable)}, Cost::Sum);
  }
}

/// What holds at first, of the worlds that one of the plans is looked for in.
void KnowledgeEstimate::sample(const Word* belief, Index plan) {
  const WorldTask& task = space_.task();
  holding_.clear();
  for (Index v = 0; v < task.variables.size(); ++v)
    if (!hidden(v)) holding_.push_back(in_world({v, task.variables[v].get(belief)}, 0));
  for (Index c = 0; c < task.components.size(); ++c) {
    const WorldSets& sets = space_.sets(c);
    const WorldSets::Members members = sets.members(space_.set_of(c, belief));
    const Index count = std::min(members.count, kSample);
    const auto start = static_cast<std::size_t>(members.count) * plan / kPlans;
    for (Index w = 0; w < kSample; ++w) {
      if (w >= count) {
        holding_.push_back(ruled_out(c, w));
        continue;
      }
      const std::size_t at =
          (start + static_cast<std::size_t>(members.count) * w / count) % members.count;
      const Word* world = sets.contents(members.first[at]);
      for (const Index v : task.components[c].variables)
        holding_.push_back(in_world({v, task.variables[v].get(world)}, w));
    }
  }
}

int KnowledgeEstimate::operator()(const Word* belief) {
  int open = 0;
  Index next = kNone;
  for (const auto& [condition, reached] : goals_) {
    if (space_.holds(*condition, belief)) continue;
    if (next == kNone) next = reached;
    ++open;
  }
  if (next == kNone) return 0;
  Index most = 1;
  for (Index c = 0; c < space_.task().components.size(); ++c)
    most = std::max(most, space_.sets(c).members(space_.set_of(c, belief)).count);
  int shortest = kDead;
  for (Index plan = 0; plan < std::min(most, kPlans); ++plan) {
    sample(belief, plan);
    const int steps = rules_.plan(holding_, next);
    if (steps >= kDead) return kDead;
    shortest = std::min(shortest, steps);
  }
  return std::min(std::min(open, kDead / kGoal) * kGoal + shortest, kDead - 1);
}

}  // namespace kaboum::plan::worlds
