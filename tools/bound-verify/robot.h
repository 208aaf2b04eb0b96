#pragma once

#include <kaboum/verify/robot_options.h>

#include <optional>
#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// What `bound-verify robot ORIGINAL RESULT` is asked.
struct VerifyRobotOptions {
  std::string original, result;  ///< URDF files
  std::string spheres;           ///< instead of the result: spheres of the links
  std::string bodies;            ///< instead of it: a URDF with capsules, boxes and spheres
  std::string page;              ///< with these: shows them; empty: none
  std::optional<std::string> epsilon_map;  ///< file of regions of the original
  verify::RobotVerdictOptions how;
  std::vector<std::string> xacro_arguments;  ///< of the original
};

/// Decides whether the collision shapes of RESULT hold ORIGINAL's shapes, link by link, and both
/// robots move alike (verify::decide); prints and reports it.
/// @return the exit code.
/// @throws Error on bad input.
int verify_robot(const VerifyRobotOptions& options, const CommonOptions& common);

/// What --epsilon-map says of the original; nothing without it.
/// @throws Error as io::read_frame_regions and robot::bounds_of_links
robot::LinkBounds bounds_of(const VerifyRobotOptions& options, const robot::RobotFile& robot);

/// What is printed of verify::difference_in_motion.
std::string line_on_joints(const std::string& difference);
/// The same as reports have it.
Json json_of_joints(const std::string& difference);

}  // namespace kaboum::tools
