#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <optional>

/// Slow, exact answers to test the libraries against. Shares no code with them but the Mesh struct:
/// own arithmetic (GMP integers: all coordinates times a common power of two), own algorithms.
namespace kaboum::test {

/// Winding number of a closed chain about p: the signed tetrahedra between the triangles and a
/// reference point in general position that contain p, counted. O(#T) exact determinants.
/// @return nullopt if p lies on a triangle.
/// @pre closed_chain(mesh), coordinates finite; otherwise the number means nothing.
std::optional<int> winding_number_slow(const geom::Mesh& mesh, const geom::Vec3& p);

/// Every directed edge is cancelled by its opposite; corners are told apart by coordinates alone
/// (−0 = +0), so unwelded meshes count as what they look like.
bool closed_chain(const geom::Mesh& mesh);

/// Every undirected edge has two triangles that run opposite ways, and the triangles round every
/// vertex form one fan; by coordinates.
bool closed_manifold(const geom::Mesh& mesh);

/// No vertex above the plane of any triangle; O(#V · #T) exact determinants.
bool exactly_convex(const geom::Mesh& mesh);

/// Pairs of triangles that meet in more than the vertices or the one edge they share by
/// coordinates. Degenerate triangles are ignored. Stops at `limit`.
std::size_t self_intersections(const geom::Mesh& mesh, std::size_t limit = 1);

/// Share of the coordinates of vertices in use that float32 cannot represent.
double share_beyond_float(const geom::Mesh& mesh);

}  // namespace kaboum::test
