#pragma once

#include <kaboum/geom/mesh.h>

#include <algorithm>
#include <cstddef>

#include "obstacle.h"

namespace kaboum::wrap {

struct CarvingOptions {
  double radius = 0;     ///< of the ball that carves; it touches the input nowhere [length]
  double offset = 0;     ///< of the corners from the input [length]
  double clearance = 0;  ///< of the outside from the input [length]
  bool float32 = true;
  std::size_t max_points = 0;

  /// Facets all of whose points are nearer to the input than this are not carved: no ball's centre
  /// passes them, and more corners would bring them little nearer. [length]
  [[nodiscard]] double rest() const { return std::min(1.25 * offset, 0.9 * radius); }
};

/// What a ball cannot reach round an obstacle: the boundary of a union of tetrahedra.
struct Carving {
  geom::Mesh mesh;  ///< closed, every edge with two triangles, every vertex with one fan
  std::size_t points = 0;
};

/// Carves a box of Delaunay tetrahedra [portaneri2022]: from outside through facets that a ball can
/// pass, taking away tetrahedra that are certainly clear of the input, and putting points onto the
/// input's offset where they are not.
///
/// @throws Error{LimitReached}
Carving carve(const geom::Mesh& input, const Obstacle& obstacle, const CarvingOptions& options);

/// @throws Error{LimitReached}, always: more points are needed than may be.
[[noreturn]] void throw_too_fine(std::size_t most);

}  // namespace kaboum::wrap
