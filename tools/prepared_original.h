#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace kaboum::tools {

/// A mesh as bmesh-decimate and bcd-decompose prepare it: what they claim is about that.
struct PreparedOriginal {
  geom::Mesh mesh;
  std::vector<std::string> notes;
  std::size_t filled_triangles = 0;
  /// Per triangle its index in the file's mesh; those that fill holes, the last ones, have none.
  std::vector<std::uint32_t> source;
};

/// @param close  fill holes as bcd-decompose does, whose claims are about a solid.
/// @throws Error{InvalidInput} as geom::prepare.
PreparedOriginal prepare_original(const geom::Mesh& mesh, bool drop_sheets, bool close);

}  // namespace kaboum::tools
