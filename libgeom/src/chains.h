#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::geom {

/// A mesh's triangles divided into chains, as fine as edges that balance allow.
struct Chains {
  std::vector<std::uint32_t> label;  ///< per triangle
  std::vector<char> closed;          ///< per chain: every directed edge cancels within it
  std::vector<char> joined;          ///< per chain: of several patches
  std::vector<int> sign;             ///< per chain: exact sign of its volume; 0 where not closed
  std::vector<double> volume;        ///< per chain, rounded [6 · length³]
};

/// Patches are joined through edges of two triangles. At other edges, patches that balance by
/// themselves stay apart, and the rest is joined.
/// @param uses   as edge_uses returns them.
/// @param group  per triangle: triangles of different groups are never joined; empty: one group.
Chains find_chains(const Mesh& mesh, std::span<const EdgeUse> uses,
                   std::span<const std::uint32_t> group = {});

/// Calls visit(uses) for the uses of each edge by each group.
template <class Visit>
void for_each_run(std::span<const EdgeUse> uses, std::span<const std::uint32_t> group,
                  Visit&& visit) {
  std::vector<EdgeUse> sorted;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    const bool one = group.empty() || std::all_of(edge.begin(), edge.end(), [&](const EdgeUse& u) {
                       return group[u.triangle] == group[edge[0].triangle];
                     });
    if (one) return visit(edge);
    sorted.assign(edge.begin(), edge.end());
    std::stable_sort(sorted.begin(), sorted.end(), [&](const EdgeUse& a, const EdgeUse& b) {
      return group[a.triangle] < group[b.triangle];
    });
    for (std::size_t k = 0; k < sorted.size();) {
      std::size_t l = k + 1;
      while (l < sorted.size() && group[sorted[l].triangle] == group[sorted[k].triangle]) ++l;
      visit(std::span<const EdgeUse>(sorted).subspan(k, l - k));
      k = l;
    }
  });
}

}  // namespace kaboum::geom
