#pragma once

#include <kaboum/verify/link_reach.h>

#include <optional>

#include "common/cli.h"
#include "robot.h"

namespace kaboum::tools {

/// Judges spheres, boxes, cylinders and capsules that a file gives a robot's links: of each link
/// whether the union of its own holds its triangles, in its frame, and the solid that they bound;
/// and whether both robots move alike: verify::difference_in_motion where the files are in one
/// format; else verify::find_frame_elsewhere, since other formats state frames in other numbers.
/// Poses are rounded: what
/// smaller bodies hold is verified, what larger ones do not hold is refuted
/// (docs/algorithms/capsules-and-boxes.md, "Robots").
/// @return the exit code
/// @throws Error on bad input: links that the robot does not have, shapes of other kinds
int verify_bodies(const VerifyRobotOptions& options, const CommonOptions& common);

/// How far bodies of links may be from these, in metres.
/// @throws Error{InvalidArgument} on a percentage: links are of several meshes
std::optional<double> length_of_reach(const std::optional<Length>& epsilon);

/// Adds what was decided of the reach of a link's bodies to its claims, as reports have it.
void add_reach(const verify::LinkReach& reach, Json& claims);

}  // namespace kaboum::tools
