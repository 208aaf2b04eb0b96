#pragma once

#include <vector>

#include "cell.h"
#include "solid_field.h"

namespace kaboum::bcd {

/// Planes that the solid's surface is a mirror image of itself in, up to a thousandth of the
/// diagonal at some hundred samples, which small features may escape. At most sixteen. Guides the
/// search, never a claim.
std::vector<Plane> mirror_planes(const SolidField& solid);

}  // namespace kaboum::bcd
