#pragma once

#include <kaboum/collide/polytope.h>

#include "simplex.h"

namespace kaboum::collide::detail {

/// are_within by exact arithmetic alone.
/// @param start  corners to begin with; its rounded numbers are not looked at.
bool are_within_exactly(const Posed& a, const Posed& b, double reach, const Simplex& start);

}  // namespace kaboum::collide::detail
