#pragma once

#include "solid.h"

namespace kaboum::bcd {

/// Whether it is certain, without subdivision, that no point of the body is farther than `distance`
/// from the solid: no triangle meets what is left of the body when its facets are moved inwards, a
/// point of that is in the solid, and no vertex of the body is farther from it.
/// @param slack  rounding, far above what is possible. [length]
/// @return false also when it is merely not certain.
bool nearly_within(const Mesh& body, const Solid& solid, double distance, double slack);

}  // namespace kaboum::bcd
