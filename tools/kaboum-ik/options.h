#pragma once

#include <kaboum/kinematics/inverse.h>

#include <set>
#include <string>
#include <vector>

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
  std::vector<std::string> xacro_arguments, packages;
  kinematics::InverseRequest request;  ///< but for the pose and the reference
  std::set<std::string> stated;        ///< names of the request's options that were stated
  bool json = false, degrees = false;
  CommonOptions common;
};

void describe(CLI::App& app, IkOptions& o);

/// @throws Error{InvalidArgument} when no robot or no pose is given.
void require_valid(const IkOptions& o);

}  // namespace kaboum::tools
