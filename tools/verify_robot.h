#pragma once

#include <string>
#include <vector>

#include "cli.h"

namespace kaboum::tools {

/// What `bound-verify --robot ORIGINAL RESULT` is asked.
struct VerifyRobotOptions {
  std::string original, result;  ///< URDF files
  std::string claims = "all", geometry = "collision", epsilon;
  std::vector<std::string> packages;
  bool prepare = false, drop_sheets = false;
  std::size_t max_contacts = 0;
  std::optional<double> max_work;
};

/// Decides whether the collision shapes of RESULT hold ORIGINAL's shapes, link by link, and both
/// robots move alike; prints and reports it. Every mesh of ORIGINAL must be held by the meshes that
/// RESULT has in the same link with the same pose and scale, so that no pose is rounded; every box,
/// cylinder and sphere must be there again.
/// @return the exit code.
/// @throws Error on bad input.
int verify_robot(const VerifyRobotOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
