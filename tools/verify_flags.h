#pragma once

#include "verify_options.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// The flags that choose a relation, and all options, which the help lists only: the commands
/// explain them.
void add_flags(CLI::App& app, VerifyOptions& options);

/// Refuses options that mean nothing beside the flag that was chosen.
/// @throws Error{InvalidArgument}
void require_meaning(const CLI::App& app, const VerifyOptions& options);

}  // namespace kaboum::tools
