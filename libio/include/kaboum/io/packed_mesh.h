#pragma once

#include <kaboum/geom/mesh.h>

#include <span>
#include <string>

namespace kaboum::io {

/// A mesh as text for pages of HTML: numbers of 32 bits, the lowest byte first, in base64.
struct PackedMesh {
  std::string points;     ///< three floats for each vertex
  std::string triangles;  ///< three numbers of vertices for each triangle
};

/// Coordinates are rounded to float32.
PackedMesh pack_mesh(const geom::Mesh& mesh);

/// The numbers in the same way.
std::string pack_floats(std::span<const float> numbers);

}  // namespace kaboum::io
