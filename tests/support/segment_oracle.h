#pragma once

#include <kaboum/geom/mesh.h>

/// Whether segments and points lie in a solid, by brute force in rational numbers (GMP). Shares no
/// code with the libraries but the Mesh struct: a place in every cone of the planes through a point
/// is displaced by a number, and its winding number counted.
namespace kaboum::test {

/// Whether all of a segment, which may be one point, is in closure{w ≥ 1} of a closed chain.
bool segment_in_solid(const geom::Vec3& p, const geom::Vec3& q, const geom::Mesh& solid);

/// Whether the segments and points that the mesh's triangles without area are, are.
bool thin_in_solid(const geom::Mesh& mesh, const geom::Mesh& solid);

}  // namespace kaboum::test
