#pragma once

#include "common/cli.h"
#include "robot.h"

namespace kaboum::tools {

/// Judges spheres, boxes, cylinders and capsules that a file gives a robot's links: of each link
/// whether the union of its own holds its triangles, in its frame, and the solid that they bound;
/// and whether both robots move alike (verify::difference_in_motion). Poses are rounded: what
/// smaller bodies hold is verified, what larger ones do not hold is refuted
/// (docs/algorithms/capsules-and-boxes.md, "Robots").
/// @return the exit code
/// @throws Error on bad input: links that the robot does not have, shapes of other kinds
int verify_bodies(const VerifyRobotOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
