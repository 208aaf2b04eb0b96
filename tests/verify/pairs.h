#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

/// Small pairs of meshes for claims of enclosure, most of them full of coincidences.
namespace kaboum::test {

struct MeshPair {
  std::string name;
  geom::Mesh inner, outer;
};

using Random = std::mt19937_64;

/// Closed chains on a coarse lattice: shared vertices, edges and faces, coplanar overlaps, opposite
/// and repeated faces, T-junctions, sheets, self-intersections, components that wind the wrong way,
/// nested ones, cavities. About half of the pairs are built so that the solid claim is likely true.
MeshPair lattice_pair(std::uint64_t seed);

/// A lattice pair whose coordinates were moved off the lattice, the same way in both meshes: what
/// was coplanar, collinear or met in a point just fails to.
MeshPair bent_pair(std::uint64_t seed);

/// A lattice pair with triangles taken out, of one mesh or the same ones of both.
MeshPair open_pair(std::uint64_t seed);

/// The same sets of points, exactly, in another order: triangles, vertices and corners permuted,
/// vertices duplicated, axes permuted and reflected (triangles turned accordingly), scaled by a
/// power of two. No coordinate is rounded.
MeshPair permuted(const MeshPair& pair, std::uint64_t seed);

/// Claims about a bounding mesh spoilt in one place; some stay true. One vertex of either mesh,
/// those at which the meshes touch preferred, is moved by 1e-3 to 1e-10 of the diagonal, the
/// outer's inwards and the inner's outwards; an edge is flipped; a component is left out.
std::vector<MeshPair> mutants(const MeshPair& pair, std::uint64_t seed, int count);

/// Boundary of the union of unit cubes, given by their lowest corners.
geom::Mesh block_chain(const std::vector<std::array<int, 3>>& cells);

/// Every triangle split into four at its edges' midpoints, exact on lattices.
geom::Mesh subdivided(const geom::Mesh& mesh);

}  // namespace kaboum::test
