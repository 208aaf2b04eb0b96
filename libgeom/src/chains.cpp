// Chains of triangles whose edges balance, and the exact signs of their volumes.
// docs/algorithms/preparation.md.
#include "chains.h"

#include <CGAL/Mpzf.h>

#include <array>
#include <cmath>
#include <map>

#include "union_find.h"

namespace kaboum::geom {
namespace {

constexpr std::uint32_t kNone = ~0U;

int balance(std::span<const EdgeUse> uses) {
  int sum = 0;
  for (const EdgeUse& u : uses) sum += u.forward ? 1 : -1;
  return sum;
}

/// Six times the volumes of closed chains, with exact signs.
void find_volumes(const Mesh& mesh, Chains& chains) {
  const std::size_t count = chains.closed.size();
  std::vector<std::uint32_t> origin(count, kNone), triangles(count, 0);
  std::vector<long double> sum(count, 0), magnitude(count, 0);
  const auto corners = [&](std::size_t t, const Vec3& o) {
    const Triangle& tri = mesh.triangles[t];
    return std::array<Vec3, 3>{mesh.vertices[tri[0]] - o, mesh.vertices[tri[1]] - o,
                               mesh.vertices[tri[2]] - o};
  };
  for (std::size_t t = 0; t < chains.label.size(); ++t) {
    const std::uint32_t c = chains.label[t];
    if (origin[c] == kNone) origin[c] = mesh.triangles[t][0];
    const auto [a, b, d] = corners(t, mesh.vertices[origin[c]]);
    sum[c] += a.dot(b.cross(d));
    magnitude[c] += 6 * a.cwiseAbs().maxCoeff() * b.cwiseAbs().maxCoeff() * d.cwiseAbs().maxCoeff();
    ++triangles[c];
  }
  chains.sign.assign(count, 0);
  chains.volume.assign(count, 0);
  std::map<std::uint32_t, CGAL::Mpzf> exact;
  for (std::uint32_t c = 0; c < count; ++c) {
    chains.volume[c] = static_cast<double>(sum[c]);
    if (chains.closed[c] == 0) continue;
    // Differences, products and sums of a term: 12 roundings of 2^-53; the sum: one of 2^-64 each.
    const long double error =
        magnitude[c] * (12 * 0x1p-53L + static_cast<long double>(triangles[c]) * 0x1p-63L);
    if (std::abs(sum[c]) > error) {
      chains.sign[c] = sum[c] > 0 ? 1 : -1;
    } else {
      exact.emplace(c, CGAL::Mpzf(0));
    }
  }
  if (exact.empty()) return;
  for (std::size_t t = 0; t < chains.label.size(); ++t) {
    const auto at = exact.find(chains.label[t]);
    if (at == exact.end()) continue;
    const Vec3& o = mesh.vertices[origin[at->first]];
    std::array<std::array<CGAL::Mpzf, 3>, 3> x;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        x[i][k] = CGAL::Mpzf(mesh.vertices[mesh.triangles[t][i]][k]) - CGAL::Mpzf(o[k]);
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      at->second = at->second + x[0][k] * (x[1][l] * x[2][m] - x[1][m] * x[2][l]);
    }
  }
  for (const auto& [c, volume] : exact) chains.sign[c] = static_cast<int>(CGAL::sign(volume));
}

}  // namespace

Chains find_chains(const Mesh& mesh, std::span<const EdgeUse> uses,
                   std::span<const std::uint32_t> group) {
  const std::size_t n = mesh.triangles.size();
  UnionFind sets(n);
  std::vector<std::vector<EdgeUse>> branched;  // balanced edges of more than two triangles
  for_each_run(uses, group, [&](std::span<const EdgeUse> run) {
    if (run.size() == 2) sets.join(run[0].triangle, run[1].triangle);
    if (run.size() > 2 && balance(run) == 0) branched.emplace_back(run.begin(), run.end());
  });
  std::uint32_t patches = 0;
  std::vector<std::uint32_t> patch(branched.empty() ? 0 : n);
  if (!branched.empty()) patch = sets.labels(&patches);
  std::vector<std::pair<std::uint32_t, int>> sums;  // per patch at an edge: forward − backward
  for (bool changed = !branched.empty(); changed;) {
    changed = false;
    for (const std::vector<EdgeUse>& run : branched) {
      sums.clear();
      for (const EdgeUse& u : run) sums.emplace_back(sets.find(u.triangle), u.forward ? 1 : -1);
      std::sort(sums.begin(), sums.end());
      std::uint32_t first = kNone;
      for (std::size_t i = 0; i < sums.size();) {
        const std::uint32_t root = sums[i].first;
        int sum = 0;
        for (; i < sums.size() && sums[i].first == root; ++i) sum += sums[i].second;
        if (sum == 0) continue;
        if (first == kNone) {
          first = root;
          continue;
        }
        sets.join(first, root);
        changed = true;
      }
    }
  }
  Chains out;
  std::uint32_t count = 0;
  out.label = sets.labels(&count);
  out.closed.assign(count, 1);
  out.joined.assign(count, 0);
  std::vector<std::uint32_t> first(count, kNone);
  for (std::size_t t = 0; t < patch.size(); ++t) {
    std::uint32_t& f = first[out.label[t]];
    if (f == kNone) f = patch[t];
    if (f != patch[t]) out.joined[out.label[t]] = 1;
  }
  for_each_run(uses, group, [&](std::span<const EdgeUse> run) {
    if (balance(run) == 0) return;
    std::map<std::uint32_t, int> sum;
    for (const EdgeUse& u : run) sum[out.label[u.triangle]] += u.forward ? 1 : -1;
    for (const auto& [c, s] : sum)
      if (s != 0) out.closed[c] = 0;
  });
  find_volumes(mesh, out);
  return out;
}

}  // namespace kaboum::geom
