#pragma once

#include <kaboum/execution/plan_page.h>
#include <kaboum/execution/robot_driver.h>
#include <kaboum/execution/run_plan.h>
#include <kaboum/plan/solve_options.h>

#include <set>
#include <string>

#include "common/cli.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// The command line of kaboum-plan: a command for each thing that it does.
namespace kaboum::tools {

struct PlanOptions {
  execution::TaskFiles task;
  plan::SearchRequest search;       ///< of solve
  execution::PlanRunRequest run;    ///< of run
  execution::DriverOptions driver;  ///< of run
  execution::PlanPageOptions page;  ///< of show
  std::set<std::string> stated;     ///< names of options of these that were stated
  std::string plan, output = "-", output_format;
  bool tree = false, explain = false, no_cache = false;
  std::string outcomes = "all", trajectories;  ///< of run
  std::string assume;                          ///< of solve: a file
  std::string html;                            ///< of show
  std::string live;                            ///< of run: a port; empty: none
  double live_linger = 0;                      ///< of run [s]
  std::string run_page, journal;               ///< of run and page; of page
  CommonOptions common;
};

/// Options that several commands have.
void add_inputs(CLI::App& app, PlanOptions& options);
void add_problem(CLI::App& app, PlanOptions& options);
/// --scene, and other sources of external functions.
CLI::Option* add_scene(CLI::App& app, PlanOptions& options);

/// Add a command each.
CLI::App* add_solve_command(CLI::App& app, PlanOptions& options);
CLI::App* add_check_command(CLI::App& app, PlanOptions& options);
CLI::App* add_show_command(CLI::App& app, PlanOptions& options);
CLI::App* add_convert_command(CLI::App& app, PlanOptions& options);

}  // namespace kaboum::tools
