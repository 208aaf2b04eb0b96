#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::verify {

/// Whether the volume that the triangles enclose, counted with signs, is below 0; exact. Internal
/// to kaboum_verify.
bool is_inside_out(const geom::Mesh& mesh);

}  // namespace kaboum::verify
