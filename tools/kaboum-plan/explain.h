#pragma once

#include <kaboum/plan/failed_calls.h>

#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// Why external functions returned no value, in a report.
Json failures_json(const std::vector<plan::FailedCalls::Failure>& failures);
/// The same for people, the most frequent ones; empty: nothing has failed.
std::string failures_text(const std::vector<plan::FailedCalls::Failure>& failures);

}  // namespace kaboum::tools
