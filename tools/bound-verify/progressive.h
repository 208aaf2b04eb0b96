#pragma once

#include <string>

#include "common/cli.h"
#include "common/unit_option.h"

namespace kaboum::tools {

/// What `bound-verify progressive ORIGINAL FILE` is asked.
struct VerifyProgressiveOptions {
  std::string original;
  InputFormat original_format;
  std::string progressive;
  UnitOption unit;  ///< of the original
};

/// Checks a progressive file against the mesh it was made from.
/// @return exit code
int verify_progressive(const VerifyProgressiveOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
