#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <vector>

namespace kaboum::geom {

/// Triangle indices along a space-filling curve (Morton's) through the triangles' centres, so that
/// runs of them lie close together. Linear time; deterministic; equal places keep their order.
std::vector<std::uint32_t> spatial_order(const Mesh& mesh);

}  // namespace kaboum::geom
