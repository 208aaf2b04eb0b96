#pragma once

#include <string>

#include "cli.h"

/// The command line of kaboum-plan: a command for each thing that it does.
namespace kaboum::tools {

struct PlanOptions {
  std::string domain, problem, scene, plan, output = "-", input_format, problem_format,
                                            output_format, search = "greedy";
  bool tree = false;
  double timeout = 0;      ///< 0: none [s]
  std::string max_memory;  ///< "500M"; empty: no limit
  CommonOptions common;
};

/// Add a command each.
CLI::App* add_solve_command(CLI::App& app, PlanOptions& options);
CLI::App* add_check_command(CLI::App& app, PlanOptions& options);
CLI::App* add_show_command(CLI::App& app, PlanOptions& options);
CLI::App* add_convert_command(CLI::App& app, PlanOptions& options);

}  // namespace kaboum::tools
