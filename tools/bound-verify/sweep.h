#pragma once

#include <kaboum/verify/robot_options.h>

#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// What `bound-verify sweep ROBOT PATH SWEPT` is asked.
struct VerifySweepOptions {
  std::string robot, path, swept;
  std::string set_format;  ///< of `swept`; empty: by its name
  std::string witness;
  std::vector<std::string> xacro_arguments;  ///< of the robot
  verify::MotionVerdictOptions how;
};

/// Decides the claims, prints and reports them. @return the exit code.
/// @throws Error on bad input.
int verify_sweep(const VerifySweepOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
