#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/winding.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace kaboum::bcd {

using geom::Mesh;
using geom::Vec3;

/// The triangles that have the complement of the solid {w ≥ 1} on a side.
struct Boundary {
  Mesh mesh;  ///< these, or the parts of them that do
  /// Points beside the triangles that are outside the solid, exactly.
  std::vector<Vec3> outside;
};

/// As far as samples tell: triangles that cross others are cut into pieces no
/// longer than `size` where samples differ, and else than `coarse` if that is more, and what
/// samples find inside the solid is left out.
/// @param doubtful  triangles where samples are known to miss something: of
/// these, pieces that meet
///   other triangles are left out only where the solid is doubly round them.
/// @param coarse  by default 5 % of the diagonal
Boundary boundary_of(const Mesh& mesh, const geom::WindingNumber& winding, double size,
                     const std::vector<std::uint32_t>& doubtful,
                     std::optional<double> coarse = std::nullopt);

}  // namespace kaboum::bcd
