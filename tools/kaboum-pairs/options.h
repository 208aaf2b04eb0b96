#pragma once

#include <kaboum/pairs/decide.h>
#include <kaboum/robot/link_meshes.h>

#include <set>
#include <string>
#include <vector>

#include "common/cli.h"
#include "judgement.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// What kaboum-pairs is asked for.
struct PairsOptions {
  std::string robot;                 ///< a file
  std::string srdf;                  ///< to write
  std::string judge;                 ///< a matrix
  std::string output, junit, sarif;  ///< to write, of the judged matrix
  FailOn fail_on;
  std::string configuration;  ///< the only one that pairs are decided in; empty: all of them
  std::string preview;        ///< to write, of that configuration
  robot::ShapeChoice choice;
  std::vector<std::string> xacro_arguments;
  pairs::DecideOptions decide;
  std::set<std::string> stated;
  bool json = false;
  CommonOptions common;
};

void describe(CLI::App& app, PairsOptions& o);

/// @throws Error{InvalidArgument} for what only means something of a judged matrix
void require_valid(const PairsOptions& o);

}  // namespace kaboum::tools
