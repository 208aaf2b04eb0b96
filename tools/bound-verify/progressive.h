#pragma once

#include <string>

#include "common/cli.h"
#include "common/unit_option.h"

namespace kaboum::tools {

/// `bound-verify progressive`: checks a progressive file against the mesh it was made from.
/// @return exit code
int verify_progressive(const std::string& original, const std::string& original_format,
                       const UnitOption& unit, const std::string& progressive,
                       const CommonOptions& common);

}  // namespace kaboum::tools
