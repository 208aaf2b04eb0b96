#pragma once

#include <kaboum/geom/mesh.h>

#include <string>
#include <vector>

namespace kaboum::test {

/// A generated mesh with what is known of it; tests loop over all of them.
struct Family {
  std::string name;
  geom::Mesh mesh;
  bool closed;  ///< the triangles, by coordinates, form a closed chain
  bool solid;   ///< closed, and some points have winding number ≥ 1
  bool convex;  ///< exactly: no vertex above any triangle's plane
};

/// Closed chains of 50 to 5000 vertices that a bounding mesh must handle: convex bodies, CAD-like
/// parts, curved and thin ones, cavities, self-intersections, non-manifold touches, slivers, sheets
/// (solid = false), degenerate triangles; some far from the origin. More than half of them have
/// coordinates that float32 cannot represent.
std::vector<Family> closed_families();

/// Meshes with a border, otherwise consistently oriented.
std::vector<Family> open_families();

/// Nothing is promised for these but a clear answer: wrong or mixed orientation, not orientable, no
/// area, empty. Indices are in range and coordinates finite.
std::vector<Family> bad_families();

}  // namespace kaboum::test
