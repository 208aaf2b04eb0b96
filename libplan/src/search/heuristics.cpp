// Heuristics are made when a search first asks for them.
#include "search/applicable_steps.h"
#include "search/invariants.h"
#include "search/landmarks.h"
#include "search/relaxation.h"
#include "search/relaxed_plan.h"
#include "search/search.h"

namespace kaboum::plan {

namespace {

/// A formula that holds in the same reachable states: of disjunctions, parts that need facts which
/// exclude each other are left out. What derived predicates are made of mostly are such.
Formula possible_part(Task& task, const Relaxation& relaxation, const Invariants& invariants,
                      Formula f, bool whole = true) {
  using Kind = FormulaPool::Kind;
  FormulaPool& pool = task.pool();
  const Kind kind = pool.node(f).kind;
  if (kind != Kind::And && kind != Kind::Or) return f;
  std::vector<Formula> parts(pool.begin(f), pool.end(f));
  for (Formula& p : parts)
    p = possible_part(task, relaxation, invariants, p, whole && kind == Kind::And);
  const Formula made = kind == Kind::And ? pool.all(parts) : pool.any(parts);
  if (whole || kind == Kind::Or) return made;
  constexpr std::size_t kMost = 100;  // that are compared with each other
  std::vector<FactId> facts = relaxation.necessary_facts(made);
  facts.resize(std::min(facts.size(), kMost));
  for (std::size_t i = 0; i < facts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (invariants.exclusive(facts[i], facts[j])) return kFalse;
  return made;
}

}  // namespace

Heuristics::Heuristics() = default;
Heuristics::~Heuristics() = default;

void Heuristics::prepare(Task& task, Limits& limits) {
  if (!relaxation) relaxation = std::make_unique<Relaxation>(task, limits);
  if (invariants) return;
  invariants = std::make_unique<Invariants>(task, *relaxation, limits);
  goal = possible_part(task, *relaxation, *invariants, task.goal());
}

RelaxedPlan& Heuristics::relaxed(Task& task, Limits& limits) {
  prepare(task, limits);
  if (!relaxed_plan) relaxed_plan = std::make_unique<RelaxedPlan>(task, *relaxation, goal);
  return *relaxed_plan;
}

LandmarkHeuristic& Heuristics::landmark(Task& task, Limits& limits) {
  prepare(task, limits);
  if (!landmarks)
    landmarks = std::make_unique<LandmarkHeuristic>(task, *relaxation, *invariants, goal);
  return *landmarks;
}

ApplicableSteps& Heuristics::steps(Task& task, Limits& limits) {
  if (!relaxation) relaxation = std::make_unique<Relaxation>(task, limits);
  if (!applicable) applicable = std::make_unique<ApplicableSteps>(task, *relaxation);
  return *applicable;
}

}  // namespace kaboum::plan
