#pragma once

#include <kaboum/geom/transform.h>

namespace kaboum::test {

/// Decides in rational numbers (GMP) whether pose_a · hull(a) and pose_b · hull(b) come within
/// `reach` of each other: by separating axes, all facets' normals and products of edges; for a
/// reach above 0 by the distances of all vertices from all triangles and of all edges from each
/// other besides. Shares nothing with libcollide.
/// @pre both are hulls with inner points.
bool rational_within(const geom::Mesh& a, const geom::Transform& pose_a, const geom::Mesh& b,
                     const geom::Transform& pose_b, double reach);

}  // namespace kaboum::test
