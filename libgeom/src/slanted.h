#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <vector>

namespace kaboum::geom {

/// A part of a triangle.
struct BoxedPiece {
  Box3 box;  ///< contains the part, and hardly more
  std::uint32_t triangle;
};

/// The triangles of a mesh in boxes, one each; those that lie slantwise in much larger boxes are
/// cut into several parts, which together are the triangle, until a line through the mesh meets few
/// boxes in vain.
///
/// Source: M. Ernst, G. Greiner, Early split clipping for bounding volume hierarchies (2007).
/// Deviation: the parts with the most empty area first, within a total.
///
/// @return the parts of one triangle as neighbours, triangles in order; empty where no triangle
/// needs cutting.
/// @pre indices in range, coordinates finite.
std::vector<BoxedPiece> cut_slanted(const Mesh& mesh);

}  // namespace kaboum::geom
