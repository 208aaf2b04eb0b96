#pragma once

#include <kaboum/base/length.h>
#include <kaboum/robot/robot.h>
#include <kaboum/verify/held_shape.h>

#include <cstddef>
#include <vector>

namespace kaboum::verify {

/// Shapes of the original's link that have one frame, and what the result's link has there.
struct MatchedShapes {
  std::vector<std::size_t> originals;  ///< meshes, or one box, cylinder or sphere
  std::vector<std::size_t> there;      ///< of the result, in the same frame
  std::size_t elsewhere = 0;           ///< shapes of the result in other frames
};

/// Pairs of shapes and their holders, in the order of the original's shapes. Frames are compared by
/// same_frame, so that a mesh is held by meshes only, and a box by a box of its size.
std::vector<MatchedShapes> match_shapes(const std::vector<robot::Geometry>& original,
                                        const std::vector<robot::Geometry>& result);

/// Decides whether a box, cylinder or sphere is there again. Other shapes may hold it, which is not
/// looked at: undecided then; so is one without volume where there is no shape at all.
Answer find_again(const robot::Geometry& shape, const MatchedShapes& match);

/// A mesh that is not held in its frame may be held by shapes in others, which is not looked at.
Answer beside_others(Answer held, const MatchedShapes& match);

/// Number of shapes of the result that match none of the original's: how far they reach from it is
/// not known.
std::size_t count_strangers(const std::vector<robot::Geometry>& original,
                            const std::vector<robot::Geometry>& result);

/// A bound of distances in the unit of scaled meshes.
struct ScaledBound {
  double bound = 0;     ///< [length, as the meshes]; not above 0 or not finite: it means nothing
  bool uneven = false;  ///< what is farther may be near enough along an axis of a smaller factor
};

/// @param epsilon   in the robot's unit, or of the largest diagonal of the meshes
/// @param diagonal  the largest [length, as the meshes]
/// @param scale     factors along the axes, above 0
ScaledBound scaled_bound(const Length& epsilon, double diagonal, const geom::Vec3& scale);

/// Undecided where not all that is to hold is closed, or an uneven scale may bring near what is too
/// far.
Answer answer_of(const HeldDistance& distance, const ScaledBound& bound);

}  // namespace kaboum::verify
