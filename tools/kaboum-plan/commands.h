#pragma once

#include "options.h"

/// What the commands of kaboum-plan do. @return the exit code. @throws Error
namespace kaboum::tools {

int solve(const PlanOptions& options);
int check(const PlanOptions& options);
int show(const PlanOptions& options);
int convert(const PlanOptions& options);

}  // namespace kaboum::tools
