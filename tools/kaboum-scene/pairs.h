#pragma once

#include "options.h"

namespace kaboum::tools {

/// kaboum-scene pairs: of a robot's links, the pairs that never touch (world/allowed_pairs.h);
/// says, reports and writes them. The exit code.
int find_pairs(const SceneOptions& o);

}  // namespace kaboum::tools
