// Decides from files alone whether what was made of a mesh, a robot or a motion keeps its promise.
#include "commands.h"

#include <CLI/CLI.hpp>
#include <iostream>

namespace tools = kaboum::tools;

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
  return tools::run(app, argc, argv, [&] { return options.decide(); });
}
