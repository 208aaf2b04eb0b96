#pragma once

#include <string>

#include "options.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// What to say where a command was meant by a flag (bound-verify --cover ORIGINAL SET); empty where
/// a command comes first, or there is no such flag.
std::string command_instead(int argc, const char* const* argv);

/// The commands mesh, cover, robot, sweep and progressive, each with the options that mean
/// something for it.
void add_commands(CLI::App& app, VerifyOptions& options);

}  // namespace kaboum::tools
