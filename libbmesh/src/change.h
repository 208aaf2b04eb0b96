#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>

namespace kaboum::bmesh {

/// A triangle that a change puts in the place of others; it reuses the index of one of them.
struct NewTriangle {
  std::uint32_t index;
  std::array<geom::Vec3, 3> corner;
};

}  // namespace kaboum::bmesh
