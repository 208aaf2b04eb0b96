#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

struct ExtractOptions {
  std::string from;                   ///< progressive file, - for standard input
  std::string output;                 ///< file, with {vertices} where there are several
  std::string format;                 ///< of the output; empty: by extension
  std::vector<std::size_t> vertices;  ///< the largest first
  std::string depfile;
  CommonOptions common;
};

/// `bmesh-decimate --from`: takes meshes from a progressive file. @return exit code
int extract_levels(const ExtractOptions& options);

}  // namespace kaboum::tools
