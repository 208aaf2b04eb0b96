#pragma once

#include <kaboum/plan/plan.h>

#include <string>
#include <vector>

// A plan's graph as every drawing shows it. Internal to kaboum_plan.
namespace kaboum::plan {

struct PlanEdge {
  Index to;  ///< kNone: the goal
  std::string label;
};

inline std::vector<PlanEdge> plan_edges(const Model& model, const Plan::Node& n) {
  if (!n.branches) return {{n.next, ""}};
  std::vector<PlanEdge> result;
  for (const Plan::Branch::Case& c : n.branch.cases)
    result.push_back({c.next, case_text(model, n.branch, c.value)});
  return result;
}

inline std::string node_label(const Model& model, const Plan::Node& n) {
  return n.acts ? action_text(model, n.action) : "branch";
}

}  // namespace kaboum::plan
