#pragma once

#include <string>
#include <vector>

#include "common/cli.h"
#include "robot.h"

namespace kaboum::tools {

/// Judges the spheres that a file gives a robot's links: of each link whether the union of its own
/// holds the triangles of its shapes and the solid that they bound, how much of their area is
/// outside, and how deep; prints and reports it. Shapes are placed in the link's frame, rounded to
/// doubles. Links without spheres have all outside.
/// @return the exit code.
/// @throws Error on bad input: links that the robot does not have, and as read_spheres.
int verify_spheres(const VerifyRobotOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
