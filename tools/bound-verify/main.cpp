// Decides from files alone whether what was made of a mesh, a robot or a motion keeps its promise.
#include "commands.h"

#include <CLI/CLI.hpp>
#include <iostream>

namespace tools = kaboum::tools;

namespace {

/// The limits that a command has: "--max-contacts, --max-work".
std::string limits_of(const CLI::App& command) {
  std::string out;
  for (const CLI::Option* option : command.get_options())
    if (const std::string name = option->get_name(); name.starts_with("--max-"))
      out += (out.empty() ? "" : ", ") + name;
  return out;
}

int decide(const CLI::App& app, const tools::VerifyOptions& options) {
  const int code = options.decide();
  if (code != tools::kLimit || !options.robot.spheres.empty() || !options.robot.bodies.empty())
    return code;
  for (const CLI::App* command : app.get_subcommands())
    if (const std::string limits = limits_of(*command); !limits.empty())
      tools::log(options.common.quiet, "undecided; a larger limit may decide it: " + limits);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Decides from files alone, in exact arithmetic, whether what was made of a mesh, a robot or "
      "a motion keeps its promise. Each command's own --help has its options:\n"
      "\n"
      "  bound-verify mesh --outer ORIGINAL RESULT    a mesh encloses the original\n"
      "  bound-verify mesh --inner ORIGINAL RESULT    a mesh is enclosed by it\n"
      "  bound-verify cover ORIGINAL SET              convex bodies cover a mesh\n"
      "  bound-verify robot ORIGINAL RESULT           a robot's shapes hold another's\n"
      "  bound-verify sweep ROBOT PATH SWEPT          convex bodies hold a motion\n"
      "  bound-verify progressive ORIGINAL FILE       all levels of a progressive file",
      "bound-verify");
  tools::VerifyOptions options;
  tools::add_commands(app, options);
  app.footer(tools::kVerifyExitCodes);
  if (const std::string command = tools::command_instead(argc, argv); !command.empty()) {
    std::cerr << "bound-verify: " << command << " (see bound-verify --help)\n";
    return tools::kUsage;
  }
  return tools::run(app, argc, argv, [&] { return decide(app, options); });
}
