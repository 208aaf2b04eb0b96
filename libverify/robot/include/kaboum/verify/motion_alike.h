#pragma once

#include <kaboum/robot/robot.h>

#include <string>

namespace kaboum::verify {

/// Why two robots do not move alike; empty if they do: links and joints of the original are in the
/// result under their names, with the same type, parent, child, origin, axis, limits and mimicked
/// variable, bit by bit.
std::string difference_in_motion(const robot::Robot& original, const robot::Robot& result);

/// True if a point of the one shape's frame is the same point of the link as in the other's: shape,
/// size (of meshes: scale) and origin are the same, bit by bit, so that no pose is rounded.
bool same_frame(const robot::Geometry& a, const robot::Geometry& b);

}  // namespace kaboum::verify
