// Chains of several patches, told apart by the winding numbers beside their regions.
// docs/algorithms/preparation.md.
#include "levels.h"

#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "triangle_contact.h"
#include "union_find.h"

namespace kaboum::geom {
namespace {

constexpr std::uint32_t kNoChain = ~0U;

class LevelSplitter {
 public:
  LevelSplitter(const Mesh& mesh, std::span<const EdgeUse> uses, Chains chains, const Bvh& bvh,
                const WindingNumber& winding)
      : mesh_(mesh), uses_(uses), chains_(std::move(chains)), bvh_(bvh), winding_(winding) {}

  Levels run() && {
    find_regions();
    if (regions_.empty()) return {std::move(chains_), {}};
    const std::size_t n = mesh_.triangles.size(), count = chains_.closed.size();
    std::vector<std::vector<std::uint32_t>> regions_of(count), triangles_of(count);
    for (std::uint32_t t = 0; t < n; ++t)
      if (stack_[t] != kNoChain) triangles_of[chains_.label[t]].push_back(t);
    for (std::uint32_t r = 0; r < regions_.size(); ++r)
      regions_of[chains_.label[regions_[r].triangles[0]]].push_back(r);
    std::vector<std::int8_t> weight(n, 0);
    std::vector<Probe> probes;
    for (std::uint32_t c = 0; c < count; ++c) {
      if (regions_of[c].empty()) continue;
      for (const std::uint32_t t : triangles_of[c]) weight[t] = 1;
      std::vector<Probe> of_chain;
      for (const std::uint32_t r : regions_of[c])
        if (std::optional<Probe> p = probe(regions_[r], weight)) of_chain.push_back(std::move(*p));
      for (const std::uint32_t t : triangles_of[c]) weight[t] = 0;
      assign_levels(of_chain);
      probes.insert(probes.end(), of_chain.begin(), of_chain.end());
    }
    std::map<std::pair<std::uint32_t, int>, std::uint32_t> ids;
    std::vector<std::uint32_t> group(n);
    for (std::uint32_t t = 0; t < n; ++t) {
      const std::uint32_t r = stack_[t] == kNoChain ? kNoChain : region_[t];
      const int level =
          r == kNoChain ? 1 : regions_[r].lowest.value_or(1) + static_cast<int>(copy_[t]);
      group[t] = ids.try_emplace({chains_.label[t], level}, static_cast<std::uint32_t>(ids.size()))
                     .first->second;
    }
    if (ids.size() != count) regroup(group);
    std::vector<Probe> doubts = doubts_of(probes, weight);
    return {std::move(chains_), std::move(doubts)};
  }

 private:
  [[nodiscard]] const Vec3& corner(std::uint32_t t, int k) const {
    return mesh_.vertices[mesh_.triangles[t][k]];
  }

  /// Triangles with the same winding numbers in front and behind, `copies` times.
  struct Region {
    std::vector<std::uint32_t> triangles;  // one of each stack of copies
    std::uint32_t copies = 1;
    std::optional<int> lowest;  // level of the first copy
    double largest = -1;        // area
    std::uint32_t largest_triangle = kNoChain;
  };

  [[nodiscard]] double area(std::uint32_t t) const {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
  }

  /// Copies of each triangle of joined chains, in ascending order; keyed by chain and corners.
  void find_regions() {
    const std::size_t n = mesh_.triangles.size();
    std::vector<std::array<std::uint32_t, 5>> keyed;  // chain, corners rotated, triangle
    for (std::uint32_t t = 0; t < n; ++t) {
      const std::uint32_t c = chains_.label[t];
      if (chains_.closed[c] == 0 || chains_.joined[c] == 0) continue;
      Triangle key = mesh_.triangles[t];
      std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
      keyed.push_back({c, key[0], key[1], key[2], t});
    }
    std::sort(keyed.begin(), keyed.end());
    stack_.assign(n, kNoChain);
    copy_.assign(n, 0);
    std::vector<std::uint32_t> copies(n, 0);  // per first triangle of a stack
    for (std::size_t i = 0; i < keyed.size();) {
      std::size_t j = i;
      for (;
           j < keyed.size() && std::equal(keyed[j].begin(), keyed[j].begin() + 4, keyed[i].begin());
           ++j) {
        stack_[keyed[j][4]] = keyed[i][4];
        copy_[keyed[j][4]] = static_cast<std::uint32_t>(j - i);
      }
      copies[keyed[i][4]] = static_cast<std::uint32_t>(j - i);
      i = j;
    }
    UnionFind sets(n);
    for_each_run(uses_, chains_.label, [&](std::span<const EdgeUse> run) {
      const std::uint32_t first = stack_[run[0].triangle];
      if (first == kNoChain) return;
      std::uint32_t second = kNoChain;
      bool opposite = false;
      for (const EdgeUse& u : run) {
        const std::uint32_t s = stack_[u.triangle];
        if (s == first || s == second) continue;
        if (second != kNoChain) return;
        second = s;
        opposite = u.forward != run[0].forward;
      }
      if (second != kNoChain && opposite && copies[first] == copies[second])
        sets.join(first, second);
    });
    region_.assign(n, kNoChain);
    for (std::uint32_t t = 0; t < n; ++t) {
      if (stack_[t] == kNoChain) continue;
      const std::uint32_t root = sets.find(stack_[t]);
      if (region_[root] == kNoChain) {
        region_[root] = static_cast<std::uint32_t>(regions_.size());
        regions_.emplace_back().copies = copies[stack_[t]];
      }
      region_[t] = region_[root];
      if (stack_[t] != t) continue;
      Region& r = regions_[region_[t]];
      r.triangles.push_back(t);
      if (const double a = area(t); a > r.largest) {
        r.largest = a;
        r.largest_triangle = t;
      }
    }
  }

  /// Winding numbers beside a region, relative to its chain alone. The points looked at lie so near
  /// to a triangle of the region that, if possible, nothing else is between.
  std::optional<Probe> probe(const Region& r, std::span<const std::int8_t> weight) const {
    std::optional<Probe> best;
    const std::size_t n = r.triangles.size();
    for (const std::uint32_t t :
         {r.largest_triangle, r.triangles[0], r.triangles[n / 2], r.triangles[n - 1]}) {
      const Vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
      const Vec3 normal = (b - a).cross(c - a);
      const double size = std::sqrt(normal.norm());
      if (!(size > 0)) continue;
      for (const Vec3& at : {Vec3((a + b + c) / 3), Vec3(0.53 * a + 0.29 * b + 0.18 * c)}) {
        for (double h = 1e-2; h > 1e-9; h *= 1e-2) {
          const Vec3 step = normal * (h / size);
          std::optional<Probe> p = look(t, at + step, at - step, weight);
          if (!p) continue;
          if (!best || p->regions.size() < best->regions.size()) best = std::move(p);
          if (best->regions.size() == 1) return best;
        }
      }
    }
    return best;
  }

  std::optional<Probe> look(std::uint32_t t, const Vec3& in_front, const Vec3& behind,
                            std::span<const std::int8_t> weight) const {
    Probe p{t, in_front, behind, 0, 0, {}};
    if (orient3d(corner(t, 0), corner(t, 1), corner(t, 2), in_front) != Sign::Positive ||
        orient3d(corner(t, 0), corner(t, 1), corner(t, 2), behind) != Sign::Negative)
      return {};
    Box3 box;
    box.extend(in_front);
    box.extend(behind);
    bool clear = true;
    bvh_.traverse([&](const Box3& b) { return clear && overlap(b, box); },
                  [&](std::uint32_t u) {
                    if (!clear || weight[u] == 0 || stack_[u] != u) return;
                    const Vec3 &a = corner(u, 0), &b = corner(u, 1), &c = corner(u, 2);
                    const Crossing x = crossing(in_front, behind, a, b, c);
                    if (x == Crossing::None) return;
                    clear = x == Crossing::Proper;
                    p.regions.emplace_back(region_[u],
                                           orient3d(a, b, c, in_front) == Sign::Positive);
                  });
    if (!clear) return {};
    const std::optional<int> front = winding_.weighted(in_front, weight),
                             back = winding_.weighted(behind, weight);
    if (!front || !back) return {};
    p.front = *front;
    p.back = *back;
    std::sort(p.regions.begin(), p.regions.end());
    for (std::size_t i = 1; i < p.regions.size(); ++i)
      if (p.regions[i].first == p.regions[i - 1].first) return {};
    return p;
  }

  /// Gives the regions the levels of their copies: the surface between winding numbers k − 1 and k
  /// is of level k. Where regions lie on each other, whichever are known from elsewhere leave the
  /// other levels to the rest. Regions that nothing is known of stay without.
  void assign_levels(const std::vector<Probe>& probes) {
    for (const Probe& p : probes) {
      if (p.regions.size() == 1) {
        regions_[p.regions[0].first].lowest = p.front + 1;
      } else if (p.regions.size() == 2 && p.regions[0].second != p.regions[1].second &&
                 p.front == p.back) {
        // Walls of touching bodies, differently triangulated.
        for (const auto& [r, same] : p.regions)
          regions_[r].lowest = p.front >= 1 ? p.front : p.front <= -1 ? p.front + 1 : 1;
      }
    }
    for (bool guess = false;;) {
      bool changed = false, open = false;
      for (const Probe& p : probes) {
        std::set<int> free;
        for (int k = p.front + 1; k <= p.back; ++k) free.insert(k);
        std::uint32_t unknown = kNoChain;
        std::size_t unknowns = 0;
        for (const auto& [i, same] : p.regions) {
          const Region& r = regions_[i];
          if (r.lowest) {
            for (std::uint32_t k = 0; k < r.copies; ++k)
              free.erase(*r.lowest + static_cast<int>(k));
            continue;
          }
          ++unknowns;
          if (unknown == kNoChain || r.largest > regions_[unknown].largest) unknown = i;
        }
        if (unknowns == 0 || free.empty()) continue;
        open = true;
        if (unknowns > 1 && !guess) continue;
        regions_[unknown].lowest = *free.begin();
        changed = true;
        if (guess) break;
      }
      if (!open) return;
      guess = !changed;
    }
  }

  /// Makes chains of the groups that are closed, and of what is left of each chain.
  void regroup(std::vector<std::uint32_t>& group) {
    const Chains levels = find_chains(mesh_, uses_, group);
    for (std::uint32_t t = 0; t < group.size(); ++t)
      group[t] = levels.closed[levels.label[t]] != 0
                     ? levels.label[t]
                     : static_cast<std::uint32_t>(levels.closed.size()) + chains_.label[t];
    chains_ = find_chains(mesh_, uses_, group);
    // A piece may be of one patch and wind both ways: it is looked at like its chain.
    for (std::uint32_t t = 0; t < group.size(); ++t)
      if (stack_[t] != kNoChain) chains_.joined[chains_.label[t]] = 1;
  }

  /// The probes near which a chain, taken alone, winds less than 0 times.
  std::vector<Probe> doubts_of(const std::vector<Probe>& probes,
                               std::vector<std::int8_t>& weight) const {
    std::vector<Probe> doubts;
    std::map<std::uint32_t, std::vector<const Probe*>> of_chain;
    for (const Probe& p : probes)
      if (std::min(p.front, p.back) < 0) of_chain[chains_.label[p.triangle]].push_back(&p);
    for (const auto& [c, list] : of_chain) {
      for (std::size_t t = 0; t < weight.size(); ++t) weight[t] = chains_.label[t] == c ? 1 : 0;
      for (const Probe* p : list) {
        const std::optional<int> front = winding_.weighted(p->in_front, weight),
                                 back = winding_.weighted(p->behind, weight);
        if (!front || !back || std::min(*front, *back) >= 0 || std::max(*front, *back) <= 0)
          continue;
        doubts.push_back(*p);
        doubts.back().front = *front;
        doubts.back().back = *back;
      }
    }
    return doubts;
  }

  const Mesh& mesh_;
  std::span<const EdgeUse> uses_;
  Chains chains_;
  const Bvh& bvh_;
  const WindingNumber& winding_;

  std::vector<std::uint32_t> stack_;   // per triangle of joined chains: the first of its copies
  std::vector<std::uint32_t> copy_;    // its place among the copies
  std::vector<std::uint32_t> region_;  // per triangle of joined chains
  std::vector<Region> regions_;
};

}  // namespace

Levels split_levels(const Mesh& mesh, std::span<const EdgeUse> uses, Chains chains, const Bvh& bvh,
                    const WindingNumber& winding) {
  return LevelSplitter(mesh, uses, std::move(chains), bvh, winding).run();
}

}  // namespace kaboum::geom
