#pragma once

#include <TopoDS_Shape.hxx>

#include "../src/cad_shape.h"

namespace kaboum::io {

/// Takes the triangles of a meshed shape, makes them finer where the exact faces and edges demand
/// it, and bounds how far these are from the triangles. docs/algorithms/cad.md
///
/// @param wish  distance of the exact faces that is aimed at [length]
/// @throws std::runtime_error naming the face or edge that cannot be bounded.
void cover_exact_shape(const TopoDS_Shape& shape, double wish, CadShape& result);

}  // namespace kaboum::io
