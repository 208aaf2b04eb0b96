#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kaboum::geom {

/// A mesh whose holes are filled.
struct FilledHoles {
  /// The mesh's vertices and triangles, unchanged and first, then what fills the holes.
  Mesh mesh;
  std::size_t holes = 0;                         ///< loops of unbalanced edges
  std::vector<std::vector<std::uint32_t>> rims;  ///< their vertices, as the fill runs round them
  double largest = 0;                            ///< diagonal of the largest hole's box [length]
  Vec3 largest_at = Vec3::Zero();                ///< middle of the largest hole
};

/// Every loop of unbalanced edges gets a fan of triangles round the loop's centroid; loops do not
/// pass from one component (joined by edges) to another. The result is a closed chain, so that it
/// has a solid.
/// @pre welded.
FilledHoles fill_holes(const Mesh& mesh);

}  // namespace kaboum::geom
