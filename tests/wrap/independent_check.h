#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::wrap {

/// Whether triangles of the mesh meet in more than what they share, as CGAL decides it
/// (Polygon_mesh_processing, which is GPL: in tests only).
bool meets_itself_by_cgal(const geom::Mesh& mesh);

}  // namespace kaboum::wrap
