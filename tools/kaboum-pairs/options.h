#pragma once

#include <kaboum/pairs/decide.h>
#include <kaboum/robot/link_meshes.h>

#include <set>
#include <string>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// What kaboum-pairs is asked for.
struct PairsOptions {
  std::string robot;  ///< a file
  std::string srdf;   ///< to write
  robot::ShapeChoice choice;
  pairs::DecideOptions decide;
  std::set<std::string> stated;
  bool json = false;
  CommonOptions common;
};

void describe(CLI::App& app, PairsOptions& o);

}  // namespace kaboum::tools
