#pragma once

#include <kaboum/robot/robot.h>

#include <cstdint>
#include <optional>
#include <string>

namespace kaboum::verify {

/// Why two robots do not move alike; empty if they do: links and joints of the original are in the
/// result under their names, with the same type, parent, child, origin, axis, limits and mimicked
/// variable, bit by bit.
std::string difference_in_motion(const robot::Robot& original, const robot::Robot& result);

/// A link whose frame is elsewhere in another file, and why.
struct FrameElsewhere {
  std::uint32_t link = 0;  ///< of the original
  std::string why;         ///< "joint 'elbow' has another axis"
};

/// The same for files with more or fewer links, and with numbers that others rounded: finds a link
/// of both robots whose frame need not be where the original has it at all values of the joints.
/// On the way to it from the first link that both have, the same joints (by name, type, multiplier,
/// offset and mimicked variable) have to follow one another, with the same axes, and fixed steps
/// between them that differ by no more than `tolerance`: of lengths, times the robot's size with
/// all joints at 0. Links in between need not be in both. The way from the root to the first link
/// is compared too, unless that link is a root. Limits are not: they move no frame.
std::optional<FrameElsewhere> find_frame_elsewhere(const robot::Robot& original,
                                                   const robot::Robot& result, double tolerance);

/// True if a point of the one shape's frame is the same point of the link as in the other's: shape,
/// size (of meshes: scale) and origin are the same, bit by bit, so that no pose is rounded.
bool same_frame(const robot::Geometry& a, const robot::Geometry& b);

}  // namespace kaboum::verify
