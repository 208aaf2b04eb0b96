#pragma once

#include "region_search.h"

namespace kaboum::verify {

/// Whether no point of the ball can be a local maximum of the distance: at one, the nearest
/// points lie in no open half-space. Those of all points of the ball are within distance +
/// 2·radius of its centre; all faces that reach there must be beyond a plane that has the ball
/// behind it.
/// @param distance  of the centre, from below
bool no_maximum(const RegionSearch& search, const Vec3& p, double radius, double distance);

}  // namespace kaboum::verify
