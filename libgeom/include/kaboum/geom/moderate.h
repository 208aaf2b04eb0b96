#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::geom {

/// Checks that products of four coordinates neither overflow nor vanish.
/// @throws Error{InvalidInput} on coordinates beyond 1e60, or an extent above 0 and below 1e-60
void require_moderate(const Mesh& mesh);

}  // namespace kaboum::geom
