#pragma once

#include <kaboum/execution/planning_task.h>
#include <kaboum/plan/plan.h>

#include <cstddef>
#include <map>
#include <string>

#include "options.h"

/// What kaboum-plan reads.
namespace kaboum::tools {

/// The files that the options name.
/// @throws Error{InvalidArgument} naming the option where a file's language is not known.
execution::TaskFiles task_files(const PlanOptions& options);

/// The task of the options; notes of its scene are logged.
/// @throws Error as execution::PlanningTask and task_files.
execution::PlanningTask read_task(const PlanOptions& options, bool answers_kept = false);

/// The language that `name` says, else that of the file's name.
/// @throws Error{InvalidArgument} naming the option when there is none.
plan::Language language_of(const std::string& file, const std::string& name, const char* option);

/// A file of outcomes. @throws Error{InvalidInput} as plan::parse_outcomes.
std::map<std::string, std::string> read_outcomes(const std::string& file);

/// @throws Error{InvalidInput} as plan::read_plan.
plan::Plan read_plan_file(const plan::Model& model, const std::string& file);

/// "500M", "2G", "1000000": bytes; 0 for none.
/// @throws Error{InvalidArgument}
std::size_t parse_memory(const std::string& text);

}  // namespace kaboum::tools
