// Fewer vertices for a convex body: those of a hull are first reduced to the ones that matter, then
// its edges are contracted outwards. docs/algorithms/convex-decomposition.md, "Fewer vertices".

#include "simplify.h"

#include <kaboum/geom/convex_hull.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "contractor.h"
#include "facet_tree.h"
#include "principal_prism.h"

namespace kaboum::bcd {
namespace {

/// Vertices above which not every contraction is the cheapest: of discs and cones of thousands,
/// contractions would leave slivers whose planes are uncertain. Work.FansOfThousandsAreOneBody.
constexpr std::size_t kMany = 384;
/// So many times the vertices allowed are left for the contractions that look for the cheapest.
constexpr std::size_t kRoughUntil = 6;
/// About what each vertex takes of reducing many. [ns]
constexpr std::uint64_t kReducedWork = 10000;
/// Rounds of adding a vertex beyond each facet; a few suffice.
constexpr int kMostRounds = 40;

double size_of(std::span<const Vec3> points) {
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  return box.diagonal();
}

/// Vertices of a convex hull whose own hull no other is farther beyond than `tolerance`: of each
/// facet's, the farthest joins, round by round. Thousands of corners of a disc come down to a few
/// hundred, and slivers, of no certain normals, with them.
std::vector<Vec3> main_vertices(std::span<const Vec3> hull, double tolerance) {
  const double size = size_of(hull);
  std::vector<std::uint32_t> open(hull.size());
  std::iota(open.begin(), open.end(), 0U);
  std::vector<Vec3> out;
  // First the extreme ones along the axes and the cube's diagonals.
  for (int i = 0; i < 27; ++i) {
    const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
    const Vec3 n(x, y, z);
    if (n.isZero()) continue;
    out.push_back(*std::max_element(hull.begin(), hull.end(), [&](const Vec3& p, const Vec3& q) {
      return n.dot(p) < n.dot(q);
    }));
  }
  geom::HullBuilder builder;
  for (int round = 0; round < kMostRounds; ++round) {
    if (!builder.build(out)) return {hull.begin(), hull.end()};
    std::vector<FacetTree::Facet> facets;
    for (const Triangle& t : builder.triangles()) {
      const Vec3& a = out[t[0]];
      const Vec3 n = (out[t[1]] - a).cross(out[t[2]] - a);
      const double length = n.norm();
      if (length > 0) facets.push_back({n / length, n.dot(a) / length});
    }
    const FacetTree tree(facets, out[0], size);
    std::map<std::uint32_t, std::pair<double, std::uint32_t>> farthest;  // by facet
    std::erase_if(open, [&](std::uint32_t v) {
      const auto [height, facet] = tree.farthest(hull[v], tolerance);
      if (height <= tolerance) return true;  // the hull only grows
      auto& [most, at] = farthest[facet];
      if (height > most) {
        most = height;
        at = v;
      }
      return false;
    });
    if (farthest.empty()) return out;
    for (const auto& [facet, point] : farthest) out.push_back(hull[point.second]);
  }
  return {hull.begin(), hull.end()};
}

}  // namespace

Simplified simplify(std::span<const Vec3> hull, std::size_t cap, double free_cost,
                    const SolidField& solid) {
  Simplified out;
  out.vertices.assign(hull.begin(), hull.end());
  out.needed = out.vertices;
  if (hull.size() <= std::min<std::size_t>(cap, 4)) return out;
  const auto prism_round = [&] {
    const auto prism = PrincipalPrism::round(hull, cap);
    return prism ? prism->corners() : std::vector<Vec3>(hull.begin(), hull.end());
  };
  geom::HullBuilder builder;
  if (!builder.build(hull)) {
    // Flat: a prism is as good as anything.
    if (hull.size() > cap) out.needed = out.vertices = prism_round();
    return out;
  }
  if (const std::size_t all = builder.vertices().size(); all > kMany) {
    solid.work().add(kReducedWork * all);
    builder.build(out.vertices = main_vertices(hull, negligible(free_cost, size_of(hull))));
  }
  const Mesh mesh = builder.mesh();
  Contractor contractor(mesh.vertices, mesh.triangles, solid, mesh.vertices.size() > kMany);
  const auto result = [&] {
    return contractor.count() <= cap ? contractor.vertices() : prism_round();
  };
  contractor.contract_roughly(std::max(kMany, kRoughUntil * cap), free_cost);
  out.cost = contractor.run(cap, free_cost, [&] { out.needed = result(); });
  out.vertices = result();
  return out;
}

}  // namespace kaboum::bcd
