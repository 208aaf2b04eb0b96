#pragma once

#include <string>

#include "verify_options.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// Whether bound-verify has a command of that name.
bool is_command(const std::string& name);

/// The commands mesh, cover, robot, sweep and progressive, each with the options that mean
/// something for it.
void add_commands(CLI::App& app, VerifyOptions& options);

}  // namespace kaboum::tools
