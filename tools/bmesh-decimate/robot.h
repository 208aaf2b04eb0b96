#pragma once

#include "options.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// bmesh-decimate on robots: every mesh of every link enclosed by one with fewer vertices, and a
/// URDF that refers to those (robot_folder.h). @return the exit code.
/// @throws Error naming the file; certify::TooCoarse.
int decimate_robot(const CLI::App& app, DecimationOptions options);

}  // namespace kaboum::tools
