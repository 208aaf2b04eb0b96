// Heuristics are made when a search first asks for them.
#include "search/applicable_steps.h"
#include "search/invariants.h"
#include "search/landmarks.h"
#include "search/relaxation.h"
#include "search/relaxed_plan.h"
#include "search/search.h"

namespace kaboum::plan {

Heuristics::Heuristics() = default;
Heuristics::~Heuristics() = default;

RelaxedPlan& Heuristics::relaxed(Task& task, Limits& limits) {
  if (!relaxation) relaxation = std::make_unique<Relaxation>(task, limits);
  if (!relaxed_plan) relaxed_plan = std::make_unique<RelaxedPlan>(task, *relaxation);
  return *relaxed_plan;
}

LandmarkHeuristic& Heuristics::landmark(Task& task, Limits& limits) {
  if (!relaxation) relaxation = std::make_unique<Relaxation>(task, limits);
  if (!invariants) invariants = std::make_unique<Invariants>(task, *relaxation, limits);
  if (!landmarks) landmarks = std::make_unique<LandmarkHeuristic>(task, *relaxation, *invariants);
  return *landmarks;
}

ApplicableSteps& Heuristics::steps(Task& task, Limits& limits) {
  if (!relaxation) relaxation = std::make_unique<Relaxation>(task, limits);
  if (!applicable) applicable = std::make_unique<ApplicableSteps>(task, *relaxation);
  return *applicable;
}

}  // namespace kaboum::plan
