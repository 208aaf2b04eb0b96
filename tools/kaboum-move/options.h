#pragma once

#include <kaboum/motion/find_path.h>
#include <kaboum/motion/keep_options.h>
#include <kaboum/motion/trajectory_options.h>
#include <kaboum/world/margins.h>

#include <set>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// The command line of kaboum-move.
struct MoveOptions {
  std::string scene, robot, from, start, goals, output = "-", trajectory, roadmap;
  std::vector<std::string> to, to_pose, reach;
  motion::PathOptions search;
  motion::TrajectoryOptions execution;
  motion::KeepRequest keep;
  world::MarginRequest margin;
  std::set<std::string> stated;  ///< names of the libraries' options that were stated
  bool degrees = false;
  CommonOptions common;
};

void describe(CLI::App& app, MoveOptions& o);

}  // namespace kaboum::tools
