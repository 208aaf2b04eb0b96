#pragma once

#include <kaboum/execution/exact_cell.h>
#include <kaboum/execution/planning_task.h>

#include <functional>
#include <string>
#include <vector>

namespace kaboum::execution {

/// Options of a page that plays a plan.
struct PlanPageOptions {
  bool tree = false;                       ///< without sharing of what branches have in common
  std::vector<std::string> packages = {};  ///< folders that package:// URIs are looked up in
  /// Is told what is being done; what it throws ends the work.
  std::function<void(const std::string& stage)> progress = {};
};

/// One HTML file that needs nothing besides itself, and what is to be known of it.
struct PlanPage {
  std::string html;
  Notes notes;  ///< why only bounding sets are shown, where an exact mesh cannot be read
};

/// A page that plays a plan's execution in the task's scene, every branch of it. docs/pages.md.
///
/// @param model  of the task
/// @throws Error{InvalidArgument} for a task without a scene; as expand_tree, plan::run and
///   Recording
PlanPage plan_page(const PlanningTask& task, const plan::Model& model, plan::Plan plan,
                   const PlanPageOptions& options = {});

}  // namespace kaboum::execution
