#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::picture {

/// Triangles cut into parts with edges of at most `longest`, so that colours show what happens
/// inside them; longer parts where many needles would make more than `most_parts`, but
/// none longer than 100 times as much.
geom::Mesh refined(const geom::Mesh& mesh, double longest, double most_parts = 1e6);

}  // namespace kaboum::picture
