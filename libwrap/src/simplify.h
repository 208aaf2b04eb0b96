#pragma once

#include "fit.h"

namespace kaboum::wrap {

/// Contracts edges as long as the surface stays within the room's offset of the input, or is not
/// farther from it than it was there, and keeps its shape where it closes gaps; cheapest first.
void simplify(Surface& surface, const Obstacle& obstacle, const Room& room, const Fit& fit);

}  // namespace kaboum::wrap
