#pragma once

#include "options.h"

/// kaboum-plan show --html: a page that plays a plan. docs/pages.md.
namespace kaboum::tools {

/// @return the exit code.
/// @throws Error
int write_page(const PlanOptions& options);

}  // namespace kaboum::tools
