#pragma once

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// Makes --help of the program, and of its subcommands, fit the terminal: $COLUMNS, else the width
/// of the terminal on stdout, else 80 columns. Ranges, defaults and exclusions come at the end of
/// an option's description.
void wrap_help(CLI::App& app);

/// What is wrong with the first argument that no option takes, and the option that was meant if one
/// is near: "unknown option --eps; did you mean --epsilon?". Empty when all are options.
std::string explain_unknown(const CLI::App& app, int argc, char** argv);

}  // namespace kaboum::tools
