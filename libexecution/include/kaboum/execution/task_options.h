#pragma once

#include <kaboum/base/option.h>
#include <kaboum/execution/plan_page.h>
#include <kaboum/execution/robot_driver.h>
#include <kaboum/execution/run_plan.h>

namespace kaboum::execution {

/// The options of a planning task: languages of its files, and external functions of a user's own.
const std::vector<Option<TaskFiles>>& task_options();

/// What a task may keep apart where a plan is found or checked, besides: margin.
const std::vector<Option<TaskFiles>>& task_margin_options();

/// Who decides contacts where a plan is found or checked: the options of engines.
const std::vector<Option<TaskFiles>>& task_engine_options();

/// The options of carrying out a plan.
const std::vector<Option<PlanRunRequest>>& run_options();

/// The options of a robot driver that carries a plan out.
const std::vector<Option<DriverOptions>>& driver_options();

/// The options of a page that plays a plan.
const std::vector<Option<PlanPageOptions>>& page_options();

}  // namespace kaboum::execution
