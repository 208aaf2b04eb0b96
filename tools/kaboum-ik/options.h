#pragma once

#include <string>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

/// What kaboum-ik is asked for.
namespace kaboum::tools {

struct IkOptions {
  std::string robot;                    ///< a file, or
  std::string scene, robot_name, tool;  ///< a scene and what of it
  std::string base, tip, pose, pose_of, reference;
  bool json = false, degrees = false, numeric = false, ignore_limits = false, copies = false,
       free_heading = false;
  int starts = 100;
  CommonOptions common;
};

void describe(CLI::App& app, IkOptions& o);

/// @throws Error{InvalidArgument} when no robot or no pose is given.
void require_valid(const IkOptions& o);

}  // namespace kaboum::tools
