#pragma once

#include <string>
#include <vector>

#include "common/cli.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// The command line of kaboum-plan: a command for each thing that it does.
namespace kaboum::tools {

struct PlanOptions {
  std::string domain, problem, scene, plan, output = "-", input_format, problem_format,
                                            output_format, search = "greedy";
  bool tree = false, time_optimal = false, explain = false, no_cache = false;
  double timeout = 0;                           ///< 0: none [s]
  std::string max_memory;                       ///< "500M"; empty: no limit
  std::string outcomes = "all", trajectories;   ///< of run
  unsigned replan = 100;                        ///< of run
  std::string assume;                           ///< of solve: a file
  std::string html;                             ///< of show
  double rate = 1000, acceleration = 5;         ///< of run [1/s; rad/s², length/s²]
  std::vector<std::string> packages;            ///< of run and show
  std::vector<std::string> processes, plugins;  ///< with external functions of a user's own
  double process_timeout = 10;                  ///< [s]
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
