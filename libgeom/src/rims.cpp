// Rims of holes: where their fill depends on a guess, and their names in the input.
// docs/algorithms/preparation.md.
#include "rims.h"

#include <kaboum/base/error.h>

#include <string>

#include "neighbours.h"

namespace kaboum::geom {

std::optional<std::uint32_t> judge_rims(std::span<const EdgeUse> edges,
                                        std::span<const std::uint32_t> source,
                                        std::span<const char> agreed) {
  std::optional<std::uint32_t> found;
  for_each_edge(edges, [&](std::span<const EdgeUse> e) {
    if (e.size() < 3 || is_balanced(e)) return;
    for (const EdgeUse& u : e) {
      found = found.value_or(source[u.triangle]);
      if (agreed[source[u.triangle]] == 0) continue;
      throw Error(ErrorCode::InvalidInput,
                  "a hole's rim runs along a wall that several bodies share, at input triangle " +
                      std::to_string(source[u.triangle]) +
                      ", and triangles there were turned to agree with their neighbours: which "
                      "body the hole is in cannot be told; close the hole, give each body a mesh "
                      "of its own, or orient all normals outwards");
    }
  });
  return found;
}

std::vector<std::vector<std::uint32_t>> name_rims(
    const std::vector<std::vector<std::uint32_t>>& rims, const Mesh& mesh,
    std::span<const std::uint32_t> source, std::span<const char> reversed) {
  std::vector<std::uint32_t> corner(mesh.vertices.size(), ~0U);
  for (std::size_t t = mesh.triangles.size(); t-- > 0;)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t in_input = reversed[t] != 0 && k != 0 ? 3 - k : k;
      corner[mesh.triangles[t][k]] = 3 * source[t] + in_input;
    }
  std::vector<std::vector<std::uint32_t>> named = rims;
  for (auto& rim : named)
    for (std::uint32_t& v : rim) v = corner[v];
  return named;
}

}  // namespace kaboum::geom
