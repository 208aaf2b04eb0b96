#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::geom {

/// Combinatorial facts about a mesh whose equal vertices have been merged.
struct TopologyReport {
  std::size_t vertices = 0;  ///< used by a triangle
  std::size_t triangles = 0;
  std::size_t edges = 0;
  std::size_t components = 0;            ///< connected by shared vertices
  std::size_t open_edges = 0;            ///< one triangle
  std::size_t nonmanifold_edges = 0;     ///< three or more triangles
  std::size_t inconsistent_edges = 0;    ///< two triangles that run the same way
  std::size_t unbalanced_edges = 0;      ///< run through more often one way than the other
  std::size_t nonmanifold_vertices = 0;  ///< triangles form more than one fan
  std::size_t degenerate_triangles = 0;  ///< no area (exact), or a corner repeated
  std::size_t duplicate_triangles = 0;   ///< same three corners as an earlier one, any orientation

  /// The oriented triangles form a closed chain: every directed edge is cancelled by its opposite.
  [[nodiscard]] bool closed() const { return unbalanced_edges == 0; }
  [[nodiscard]] bool manifold() const {
    return nonmanifold_edges == 0 && nonmanifold_vertices == 0 && inconsistent_edges == 0;
  }
};

/// @pre indices in range.
TopologyReport analyse(const Mesh& mesh);

/// True if the triangle has no area; exact.
bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c);

/// Merges vertices with equal coordinates (−0 = +0) and drops those that no triangle uses; vertices
/// keep the order of their first use. Triangles are neither dropped nor reordered.
Mesh weld(const Mesh& mesh);

/// An undirected edge and the triangles on it.
struct EdgeUse {
  std::uint32_t lo, hi;  ///< vertex indices, lo < hi
  std::uint32_t triangle;
  std::uint8_t corner;  ///< the edge runs from corner to corner+1 of the triangle
  bool forward;         ///< the triangle runs lo → hi
};

/// All sides of all triangles without a repeated corner, sorted by (lo, hi, triangle).
std::vector<EdgeUse> edge_uses(const Mesh& mesh);

/// Calls visit(std::span<const EdgeUse>) once for each edge, with all its uses.
/// @param uses  as edge_uses returns them.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, Visit&& visit) {
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].lo == uses[i].lo && uses[j].hi == uses[i].hi) ++j;
    visit(uses.subspan(i, j - i));
    i = j;
  }
}

/// Component of each triangle (0, 1, …, numbered by first triangle), connected through shared
/// vertices or, when `through_edges`, only through shared edges.
std::vector<std::uint32_t> components(const Mesh& mesh, bool through_edges, std::uint32_t* count);

/// The same through shared edges, which are known already. @param uses as edge_uses returns them.
std::vector<std::uint32_t> components(std::span<const EdgeUse> uses, std::size_t triangles,
                                      std::uint32_t* count);

}  // namespace kaboum::geom
