// Orientation of patches: which triangles are turned so that neighbours agree.
// docs/algorithms/preparation.md.
#include "neighbours.h"

#include <kaboum/base/error.h>

#include <array>

namespace kaboum::geom {

Agreement agree_with_neighbours(const Mesh& mesh, std::span<const EdgeUse> edges,
                                std::span<const std::uint32_t> source) {
  Agreement out;
  const auto neighbours = [&](std::span<const EdgeUse> e) {
    return e.size() == 2 && opposite_corner(mesh, e[0]) != opposite_corner(mesh, e[1]);
  };
  for_each_edge(edges, [&](std::span<const EdgeUse> e) {
    out.inconsistent += !is_balanced(e) && neighbours(e);
  });
  if (out.inconsistent == 0) return out;

  const std::size_t n = mesh.triangles.size();
  struct Neighbour {
    std::uint32_t triangle = ~0U;
    bool agrees = true;
  };
  std::vector<std::array<Neighbour, 3>> across(n);
  for_each_edge(edges, [&](std::span<const EdgeUse> e) {
    if (!neighbours(e)) return;  // copies of one triangle are none
    const bool agrees = e[0].forward != e[1].forward;
    across[e[0].triangle][e[0].corner] = {e[1].triangle, agrees};
    across[e[1].triangle][e[1].corner] = {e[0].triangle, agrees};
  });
  constexpr std::int8_t kUnseen = 0;
  std::vector<std::int8_t> sense(n, kUnseen);
  std::vector<std::uint32_t> patch;
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (sense[seed] != kUnseen) continue;
    patch.assign(1, seed);
    sense[seed] = 1;
    double balance = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const std::uint32_t t = patch[i];
      const Triangle& tri = mesh.triangles[t];
      const Vec3& a = mesh.vertices[tri[0]];
      balance += sense[t] * (mesh.vertices[tri[1]] - a).cross(mesh.vertices[tri[2]] - a).norm();
      for (const Neighbour& nb : across[t]) {
        if (nb.triangle == ~0U) continue;
        const auto expected = static_cast<std::int8_t>(nb.agrees ? sense[t] : -sense[t]);
        if (sense[nb.triangle] == kUnseen) {
          sense[nb.triangle] = expected;
          patch.push_back(nb.triangle);
        } else if (sense[nb.triangle] != expected) {
          throw Error(ErrorCode::InvalidInput,
                      "the surface is one-sided (not orientable) at input triangle " +
                          std::to_string(source[nb.triangle]) +
                          ", so it bounds no solid; cut it or close it to a two-sided surface");
        }
      }
    }
    const std::int8_t against = balance < 0 ? 1 : -1;
    const std::size_t before = out.reverse.size();
    for (const std::uint32_t t : patch)
      if (sense[t] == against) out.reverse.push_back(t);
    if (out.reverse.size() != before)
      out.affected.insert(out.affected.end(), patch.begin(), patch.end());
  }
  return out;
}

}  // namespace kaboum::geom
