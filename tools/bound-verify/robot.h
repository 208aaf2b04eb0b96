#pragma once

#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// What `bound-verify robot ORIGINAL RESULT` is asked.
struct VerifyRobotOptions {
  std::string original, result;  ///< URDF files
  std::string claims = "all", geometry = "collision", epsilon;
  std::vector<std::string> packages, links;
  std::string prepare;  ///< empty, auto or wrap
  bool drop_sheets = false;
  std::size_t max_contacts = 0;
  std::optional<double> max_work;
  std::size_t exact_points = 0;  ///< of CAD files; 0: triangles alone
};

/// Decides whether the collision shapes of RESULT hold ORIGINAL's shapes, link by link, and both
/// robots move alike (verify::decide); prints and reports it.
/// @return the exit code.
/// @throws Error on bad input.
int verify_robot(const VerifyRobotOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
