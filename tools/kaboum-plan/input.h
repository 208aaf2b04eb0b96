#pragma once

#include <kaboum/execution/planning_task.h>
#include <kaboum/plan/plan.h>

#include <map>
#include <string>

#include "options.h"

/// What kaboum-plan reads.
namespace kaboum::tools {

/// The task of the options; notes of its scene are logged.
/// @throws Error as execution::PlanningTask.
execution::PlanningTask read_task(const PlanOptions& options, bool answers_kept = false);

/// What is left out of contacts in a task's scene, as world::pads_claim; empty: nothing.
std::string pads_of(const execution::PlanningTask& task);

/// A file of outcomes. @throws Error{InvalidInput} as plan::parse_outcomes.
std::map<std::string, std::string> read_outcomes(const std::string& file);

/// The plan of --plan; says where nothing of it is certified.
/// @throws Error{InvalidInput} as plan::read_plan.
plan::Plan read_plan_file(const plan::Model& model, const PlanOptions& options);

/// @throws Error{InvalidArgument} for options of --engine without it.
void require_engine_meaning(const PlanOptions& options);

}  // namespace kaboum::tools
