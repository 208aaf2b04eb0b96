#pragma once

#include <kaboum/collide/bounding_set.h>

#include <vector>

#include "faces.h"

/// Parts of convex sets that are round about an axis.
namespace kaboum::scene {

/// Part of a set between two heights along an axis about which it is round, and hardly narrower at
/// one height than at another: two fingers hold it anywhere round the axis.
struct RoundSide {
  Vec3 point, axis;          ///< heights are counted from the point, along the axis
  double low = 0, high = 0;  ///< [length]
  double radius = 0;         ///< nothing between the heights is farther from the axis [length]
  double tolerance = 0;      ///< the hull between the heights is nowhere narrower by more [length]
};

/// The round sides of a set, the largest first.
///
/// Between two heights a set is round about an axis where the hull of what is there holds a circle
/// about the axis that is smaller than the largest distance from the axis by ε and 2 % of it at
/// most: a prism of 16 sides is round, one of 12 is not. Heights are looked at in 64 slabs. The
/// side leans by 10 degrees at most.
///
/// Axes that are looked at go along an axis of the set's frame, the core of a capsule, or the
/// normal of one of the largest faces, through the middle of the smallest circle round the set's or
/// a body's projection.
/// @param widest  largest diameter of a side [length]
std::vector<RoundSide> round_sides_of(const Faces& faces, double widest);

}  // namespace kaboum::scene
