#pragma once

#include "options.h"

namespace CLI {
class App;
}  // namespace CLI

/// kaboum-plan run: a plan carried out in simulation, judged by exact meshes.
namespace kaboum::tools {

CLI::App* add_run_command(CLI::App& app, PlanOptions& options);

/// @return 0: every motion that was carried out is as it should be; 1: it is not.
/// @throws Error
int run_plan(const PlanOptions& options);

}  // namespace kaboum::tools
