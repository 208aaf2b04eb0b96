#pragma once

#include <kaboum/geom/mesh.h>
#include <TopoDS_Shape.hxx>

#include <cstddef>
#include <string>
#include <vector>

namespace kaboum::io {

/// The area of a face, between value - error and value + error.
struct AreaBounds {
  double value = 0, error = 0;
};

/// The triangles of an exact shape, and what is proved of them.
struct ExactCover {
  std::vector<geom::Vec3> points;
  std::vector<geom::Triangle> triangles;
  std::vector<std::size_t> ends;  ///< of the triangles of each face, in the order of the shape's
  std::vector<AreaBounds> areas;  ///< of the exact faces, over the parameters of the triangles
  std::size_t bare_faces = 0;     ///< that have no triangles; then nothing else is said
  double distance = 0;            ///< no point of a face or an edge is farther from the triangles
  double gap = 0;                 ///< no edge's curve is farther from its faces
  std::string farthest, widest;   ///< where these were found
  std::size_t pieces = 0;         ///< of faces and edges that were bounded
};

/// Takes the triangles of a meshed shape, makes them finer where the exact faces and edges demand
/// it, and bounds how far these are from the triangles. docs/algorithms/cad.md
///
/// @param wish  distance of the exact faces that is aimed at [length]
/// @param most  that an edge's curve may be beside its faces [length]
/// @throws std::runtime_error naming the face or edge that cannot be bounded, or is farther.
ExactCover cover_exact_shape(const TopoDS_Shape& shape, double wish, double most);

}  // namespace kaboum::io
