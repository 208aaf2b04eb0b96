#pragma once

#include "options.h"

namespace kaboum::tools {

/// Whole robots: the shapes of every link as convex bodies, and a URDF that refers to them
/// (robot_folder.h). @return the exit code.
/// @throws Error naming the file; certify::TooCoarse.
int decompose_robot(const DecomposeOptions& options);

}  // namespace kaboum::tools
