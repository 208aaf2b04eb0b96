#pragma once

#include <TopoDS_Shape.hxx>

#include "exact_cover.h"

namespace kaboum::io {

/// Holds volume, areas of plane faces and box of the exact shape, by OpenCASCADE's integrals,
/// against the triangles. docs/algorithms/cad.md
///
/// @param deviation  no point of the exact shape is farther from the triangles
/// @param solid      all faces belong to solids
/// @throws std::runtime_error where they differ by more than the deviation explains.
void check_integrals(const TopoDS_Shape& shape, const ExactCover& cover, double deviation,
                     bool solid);

}  // namespace kaboum::io
