#pragma once

#include <kaboum/engines/engine_world.h>
#include <kaboum/motion/keep_options.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/world/margins.h>
#include <kaboum/world/motion_check.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

/// What kaboum-check is asked for.
namespace kaboum::tools {

/// What joints do between waypoints.
inline constexpr const char *kStraight = "straight", *kCubic = "cubic", *kQuintic = "quintic";

struct CheckOptions {
  std::string scene, robot, configuration, configurations, batch, motions, verdicts, preview;
  std::vector<std::string> paths, inside, clouds, cloud_allow;
  std::optional<Length> cloud_radius;
  std::string cloud_pose, between = kStraight;
  bool cloud_drop_invalid = false;
  robot::PathOptions reading;
  world::Checker::Options state;
  world::MotionOptions motion;
  motion::KeepRequest keep;
  world::MarginRequest margin;
  std::set<std::string> stated;  ///< names of the options of these that were stated
  engines::EngineRequest engine;
  bool distance = false, compare = false;
  CommonOptions common;
};

void describe(CLI::App& app, CheckOptions& o);

}  // namespace kaboum::tools
