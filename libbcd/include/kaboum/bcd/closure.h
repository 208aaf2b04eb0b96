#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::bcd {

/// The mesh with its holes filled: every loop of unbalanced edges gets a fan of triangles round the
/// loop's centroid. The result is a closed chain, so that it has a solid; the triangles that were
/// there come first, unchanged.
/// @pre welded.
geom::Mesh close_holes(const geom::Mesh& mesh);

}  // namespace kaboum::bcd
