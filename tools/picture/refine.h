#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::picture {

/// Triangles cut into parts with edges of at most `longest`, so that colours show what happens
/// inside them; longer parts where many needles would make more than a million.
geom::Mesh refined(const geom::Mesh& mesh, double longest);

}  // namespace kaboum::picture
