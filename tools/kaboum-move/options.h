#pragma once

#include <kaboum/motion/find_path.h>
#include <kaboum/motion/trajectory.h>

#include <set>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// The command line of kaboum-move.
struct MoveOptions {
  std::string scene, robot, from, start, goals, output = "-", trajectory;
  std::vector<std::string> to, velocities, accelerations;
  motion::PathOptions search;
  std::set<std::string> stated;  ///< names of the search's options that were stated
  bool degrees = false, time_optimal = false;
  double rate = 1000;
  CommonOptions common;
};

void describe(CLI::App& app, MoveOptions& o);

/// Of --max-velocity and --max-acceleration; never above the velocities of the robot's file.
/// @throws Error{InvalidArgument} for values that are not above 0, joints that are not known, and
///   one joint's velocity above the file's.
motion::SpeedLimits speed_limits(const MoveOptions& o, const robot::Robot& robot);

}  // namespace kaboum::tools
