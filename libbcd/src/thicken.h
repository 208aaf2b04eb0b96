#pragma once

#include "solid_field.h"

namespace kaboum::bcd {

/// An exactly convex float32 polytope round the body that is certainly at least `thickness` wide in
/// every direction: the body swept to both sides in the direction where it is narrowest, until it
/// is. The body itself when it is wide enough.
/// @param most  vertices, ≥ 8.
Mesh thicken(Mesh body, double thickness, std::size_t most, const SolidField& solid);

}  // namespace kaboum::bcd
