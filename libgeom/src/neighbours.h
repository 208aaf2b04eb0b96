#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::geom {

/// Whether as many triangles run through the edge one way as the other.
inline bool is_balanced(std::span<const EdgeUse> edge) {
  const auto forward =
      std::count_if(edge.begin(), edge.end(), [](const EdgeUse& e) { return e.forward; });
  return 2 * static_cast<std::size_t>(forward) == edge.size();
}

/// The corner of the use's triangle that is not on its edge.
inline std::uint32_t opposite_corner(const Mesh& mesh, const EdgeUse& use) {
  return mesh.triangles[use.triangle][(use.corner + 2) % 3];
}

/// What makes a mesh's patches consistent.
struct Agreement {
  std::size_t inconsistent = 0;         ///< edges with two triangles that run the same way
  std::vector<std::uint32_t> reverse;   ///< triangles to be turned
  std::vector<std::uint32_t> affected;  ///< all triangles of patches with such triangles
};

/// Patches connected through edges with exactly two triangles are oriented consistently, by the
/// orientation that most of their area has already.
/// @param edges   as edge_uses returns them.
/// @param source  per triangle: its number in messages.
/// @throws Error{InvalidInput} where a patch is one-sided.
Agreement agree_with_neighbours(const Mesh& mesh, std::span<const EdgeUse> edges,
                                std::span<const std::uint32_t> source);

}  // namespace kaboum::geom
