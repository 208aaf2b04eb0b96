#pragma once

#include "options.h"

namespace CLI {
class App;
}  // namespace CLI

/// kaboum-plan show --html, a page that plays a plan; kaboum-plan page, of a run. docs/pages.md.
namespace kaboum::tools {

/// @return the exit code.
/// @throws Error
int write_page(const PlanOptions& options);

CLI::App* add_page_command(CLI::App& app, PlanOptions& options);

/// The page of a run, from its journal and the scene.
/// @return the exit code.
/// @throws Error
int write_run_page(const PlanOptions& options);

}  // namespace kaboum::tools
