#pragma once

#include <kaboum/geom/solid_mesh.h>

#include <utility>

namespace kaboum::geom {

/// The one place that makes a SolidMesh of parts; whoever calls it answers for what the type says.
struct SolidMeshMaker {
  static SolidMesh make(Mesh mesh, std::vector<char> border, bool closed,
                        std::size_t filled_triangles) {
    SolidMesh out;
    out.mesh_ = std::move(mesh);
    out.border_ = std::move(border);
    out.closed_ = closed;
    out.filled_triangles_ = filled_triangles;
    return out;
  }
};

}  // namespace kaboum::geom
