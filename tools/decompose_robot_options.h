#pragma once

#include "decompose_options.h"

namespace kaboum::tools {

void add_robot_options(CLI::App& app, DecomposeOptions& options);

/// Options that a plain mesh has no use for are mistakes.
/// @throws Error{InvalidArgument}
void require_options_of_meshes(const CLI::App& app, const DecomposeOptions& options);

}  // namespace kaboum::tools
