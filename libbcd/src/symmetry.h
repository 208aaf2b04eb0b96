#pragma once

#include <vector>

#include "cell.h"
#include "solid.h"

namespace kaboum::bcd {

/// Planes that the solid's surface is a mirror image of itself in, up to a thousandth of the
/// diagonal at samples. Guides the search, never a claim; not all of a ball's are found.
std::vector<Plane> mirror_planes(const Solid& solid);

}  // namespace kaboum::bcd
