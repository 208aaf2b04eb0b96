#pragma once

#include <kaboum/geom/convex_set.h>

#include <array>
#include <vector>

namespace kaboum::distance {

/// The boundary of a solid, triangulated; normals point out of the solid.
struct Boundary {
  geom::Mesh mesh;
  std::vector<std::array<geom::Vec3, 3>>
      facet;                ///< for each triangle the input's that it is a part of, turned outwards
  std::vector<char> whole;  ///< for each triangle: it is not a part, but all of it, exactly
  double error = 0;  ///< every point of either surface, `mesh` and the boundary, is within this
                     ///< distance of the other [length]
};

/// @throws Error{InvalidInput} naming the first body that is not convex.
void require_convex(const geom::ConvexSet& set);

/// The boundary of the union of the bodies' cores. Clips every facet against all other bodies; what
/// lies inside them, or between two bodies that touch there, is left out. Radii are not looked at.
///
/// Cuts are made in exact rational arithmetic and their corners rounded once; `error` bounds what
/// that moves (docs/algorithms/distances.md, "Convex sets").
///
/// @throws Error{InvalidInput} naming a body that is not convex.
/// @pre the cores are polytopes
Boundary union_boundary(const geom::ConvexSet& set);

/// The boundary of the solid closure{x : w(x) ≥ 1} of a closed chain, however it crosses itself:
/// what lies inside is left out, and coinciding parts are kept once. Triangles that meet others
/// only in common sides and corners are kept or left out as they are, in patches. The others are
/// cut exactly where they meet, their corners rounded once (`error`), and each part is decided by
/// the winding numbers of its two sides.
///
/// @throws Error{InvalidInput} if the triangles form no closed chain, or the solid is empty.
/// @pre indices in range, coordinates finite.
Boundary solid_boundary(const geom::Mesh& mesh);

}  // namespace kaboum::distance
