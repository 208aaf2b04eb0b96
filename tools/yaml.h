#pragma once

#include <string>

#include "report.h"

namespace kaboum::tools {

/// JSON as YAML that people like to read: a line for each member, lists of numbers on one line,
/// strings in quotation marks.
std::string to_yaml(const Json& json);

}  // namespace kaboum::tools
