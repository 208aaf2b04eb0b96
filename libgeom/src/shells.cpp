// Which shells of a mesh are inside out. Shells that meet at a doubled wall are told apart by the
// winding numbers on both sides of the wall; a shell oriented inwards is a cavity only if it lies
// in one shell, exactly.
#include <kaboum/geom/bvh.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/winding.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mpzf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <set>

#include "shells.h"
#include "union_find.h"

namespace kaboum::geom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr std::uint32_t kNone = ~0U;

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

// -- contact of triangles -------------------------------------------------------------------------

Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Whether two triangles without repeated corners meet in anything but a corner or an edge that
/// both have; exact. Triangles without area lie on their neighbours' edges and are left to those.
bool meet_improperly(const Mesh& mesh, std::uint32_t t, std::uint32_t u) {
  const Triangle &x = mesh.triangles[t], &y = mesh.triangles[u];
  const auto at = [&](std::uint32_t v) -> const Vec3& { return mesh.vertices[v]; };
  const auto beside = [&](const Triangle& plane, const Triangle& other) {
    bool above = true, below = true;
    for (const std::uint32_t v : other) {
      const Sign s = orient3d(at(plane[0]), at(plane[1]), at(plane[2]), at(v));
      above = above && s == Sign::Positive;
      below = below && s == Sign::Negative;
    }
    return above || below;
  };
  if (beside(x, y) || beside(y, x)) return false;
  if (is_degenerate(at(x[0]), at(x[1]), at(x[2])) || is_degenerate(at(y[0]), at(y[1]), at(y[2])))
    return false;
  std::vector<std::uint32_t> common, rest_x, rest_y;
  for (const std::uint32_t v : x)
    (std::find(y.begin(), y.end(), v) != y.end() ? common : rest_x).push_back(v);
  for (const std::uint32_t v : y)
    if (std::find(x.begin(), x.end(), v) == x.end()) rest_y.push_back(v);
  const auto triangle = [&](const Triangle& c) {
    return Kernel::Triangle_3(point(at(c[0])), point(at(c[1])), point(at(c[2])));
  };
  const auto segment = [&](const std::vector<std::uint32_t>& c) {
    return Kernel::Segment_3(point(at(c[0])), point(at(c[1])));
  };
  switch (common.size()) {
    case 0:
      return CGAL::do_intersect(triangle(x), triangle(y));
    case 1:
      return CGAL::do_intersect(triangle(x), segment(rest_y)) ||
             CGAL::do_intersect(triangle(y), segment(rest_x));
    case 2: {
      const auto a = point(at(common[0])), b = point(at(common[1])), c = point(at(rest_x[0])),
                 d = point(at(rest_y[0]));
      return CGAL::coplanar(a, b, c, d) && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
    }
    default:
      return true;
  }
}

enum class Crossing { None, Proper, Unclear };

/// Whether the segment from p to q passes through the inside of the triangle; exact.
Crossing crossing(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int sp = static_cast<int>(orient3d(a, b, c, p)),
            sq = static_cast<int>(orient3d(a, b, c, q));
  if (sp == sq && sp != 0) return Crossing::None;
  const int u = static_cast<int>(orient3d(p, q, a, b)), v = static_cast<int>(orient3d(p, q, b, c)),
            w = static_cast<int>(orient3d(p, q, c, a));
  if (std::min({u, v, w}) < 0 && std::max({u, v, w}) > 0) return Crossing::None;
  return sp * sq < 0 && u == v && v == w && u != 0 ? Crossing::Proper : Crossing::Unclear;
}

// -- shells ---------------------------------------------------------------------------------------

class Judge {
 public:
  Judge(const Mesh& mesh, std::span<const EdgeUse> uses, std::span<const std::uint32_t> was_open)
      : mesh_(mesh), uses_(uses), was_open_(was_open), chains_(find_chains(mesh, uses, was_open)) {}

  Judgement run() {
    out_.turn.assign(mesh_.triangles.size(), 0);
    const auto doubtful = [&](std::uint32_t c) {
      return chains_.closed[c] != 0 && (chains_.joined[c] != 0 || chains_.sign[c] < 0);
    };
    std::uint32_t c = 0;
    while (c < chains_.closed.size() && !doubtful(c)) ++c;
    if (c == chains_.closed.size()) return std::move(out_);
    bvh_ = std::make_shared<const Bvh>(mesh_);
    winding_ = std::make_unique<const WindingNumber>(mesh_, bvh_);
    take_apart();
    turn_shells();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const Vec3& corner(std::uint32_t t, int k) const {
    return mesh_.vertices[mesh_.triangles[t][k]];
  }

  // -- chains of several patches: told apart by levels

  /// Triangles with the same winding numbers in front and behind, `copies` times.
  struct Region {
    std::vector<std::uint32_t> triangles;  // one of each stack of copies
    std::uint32_t copies = 1;
    std::optional<int> lowest;  // level of the first copy
    double largest = -1;        // area
    std::uint32_t largest_triangle = kNone;
  };

  /// Winding numbers in front of a triangle and behind, and the regions between.
  struct Probe {
    std::uint32_t triangle = kNone;
    Vec3 in_front, behind;
    int front = 0, back = 0;
    std::vector<std::pair<std::uint32_t, bool>> regions;  // oriented as the triangle?
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
    stack_.assign(n, kNone);
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
      if (first == kNone) return;
      std::uint32_t second = kNone;
      bool opposite = false;
      for (const EdgeUse& u : run) {
        const std::uint32_t s = stack_[u.triangle];
        if (s == first || s == second) continue;
        if (second != kNone) return;
        second = s;
        opposite = u.forward != run[0].forward;
      }
      if (second != kNone && opposite && copies[first] == copies[second]) sets.join(first, second);
    });
    region_.assign(n, kNone);
    for (std::uint32_t t = 0; t < n; ++t) {
      if (stack_[t] == kNone) continue;
      const std::uint32_t root = sets.find(stack_[t]);
      if (region_[root] == kNone) {
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
    bvh_->traverse([&](const Box3& b) { return clear && overlap(b, box); },
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
    const std::optional<int> front = winding_->weighted(in_front, weight),
                             back = winding_->weighted(behind, weight);
    if (!front || !back) return {};
    p.front = *front;
    p.back = *back;
    std::sort(p.regions.begin(), p.regions.end());
    for (std::size_t i = 1; i < p.regions.size(); ++i)
      if (p.regions[i].first == p.regions[i - 1].first) return {};
    return p;
  }

  static bool overlap(const Box3& a, const Box3& b) {
    return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
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
        std::uint32_t unknown = kNone;
        std::size_t unknowns = 0;
        for (const auto& [i, same] : p.regions) {
          const Region& r = regions_[i];
          if (r.lowest) {
            for (std::uint32_t k = 0; k < r.copies; ++k)
              free.erase(*r.lowest + static_cast<int>(k));
            continue;
          }
          ++unknowns;
          if (unknown == kNone || r.largest > regions_[unknown].largest) unknown = i;
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

  /// Splits off what is closed within one level of a chain; the rest of the chain, closed as well,
  /// stays together.
  void take_apart() {
    find_regions();
    if (regions_.empty()) return;
    const std::size_t n = mesh_.triangles.size(), count = chains_.closed.size();
    std::vector<std::vector<std::uint32_t>> regions_of(count), triangles_of(count);
    for (std::uint32_t t = 0; t < n; ++t)
      if (stack_[t] != kNone) triangles_of[chains_.label[t]].push_back(t);
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
      const std::uint32_t r = stack_[t] == kNone ? kNone : region_[t];
      const int level =
          r == kNone ? 1 : regions_[r].lowest.value_or(1) + static_cast<int>(copy_[t]);
      group[t] = ids.try_emplace({chains_.label[t], level}, static_cast<std::uint32_t>(ids.size()))
                     .first->second;
    }
    if (ids.size() == count) {
      keep_doubts(probes, weight);
      return;
    }
    const Chains levels = find_chains(mesh_, uses_, group);
    for (std::uint32_t t = 0; t < n; ++t)
      group[t] = levels.closed[levels.label[t]] != 0
                     ? levels.label[t]
                     : static_cast<std::uint32_t>(levels.closed.size()) + chains_.label[t];
    chains_ = find_chains(mesh_, uses_, group);
    // A piece may be of one patch and wind both ways: it is looked at like its chain.
    for (std::uint32_t t = 0; t < n; ++t)
      if (stack_[t] != kNone) chains_.joined[chains_.label[t]] = 1;
    keep_doubts(probes, weight);
  }

  /// The probes near which a chain, taken alone, winds less than 0 times.
  void keep_doubts(const std::vector<Probe>& probes, std::vector<std::int8_t>& weight) {
    std::map<std::uint32_t, std::vector<const Probe*>> of_chain;
    for (const Probe& p : probes)
      if (std::min(p.front, p.back) < 0) of_chain[chains_.label[p.triangle]].push_back(&p);
    for (const auto& [c, list] : of_chain) {
      for (std::size_t t = 0; t < weight.size(); ++t) weight[t] = chains_.label[t] == c ? 1 : 0;
      for (const Probe* p : list) {
        const std::optional<int> front = winding_->weighted(p->in_front, weight),
                                 back = winding_->weighted(p->behind, weight);
        if (!front || !back || std::min(*front, *back) >= 0 || std::max(*front, *back) <= 0)
          continue;
        doubts_.push_back(*p);
        doubts_.back().front = *front;
        doubts_.back().back = *back;
      }
    }
    weight.assign(weight.size(), 0);
  }

  /// Whether triangles of a chain pass through each other.
  [[nodiscard]] bool crosses_itself(std::uint32_t c) const {
    const auto coplanar = [&](std::uint32_t t, std::uint32_t u) {
      for (int k = 0; k < 3; ++k)
        if (orient3d(corner(t, 0), corner(t, 1), corner(t, 2), corner(u, k)) != Sign::Zero)
          return false;
      return true;
    };
    bool found = false;
    for (const std::uint32_t t : members_[c]) {
      Box3 box;
      for (int k = 0; k < 3; ++k) box.extend(corner(t, k));
      bvh_->traverse([&](const Box3& b) { return !found && overlap(b, box); },
                     [&](std::uint32_t u) {
                       found = found || (u > t && chains_.label[u] == c &&
                                         meet_improperly(mesh_, t, u) && !coplanar(t, u));
                     });
      if (found) return true;
    }
    return false;
  }

  // -- which shells are turned

  /// Where a shell lies with respect to the others.
  struct Position {
    std::map<std::uint32_t, int> winding;  ///< of each shell round this one, where not 0
    std::set<std::uint32_t> unclear;       ///< shells that it meets in more than corners and edges

    [[nodiscard]] int of(std::uint32_t shell) const {
      const auto at = winding.find(shell);
      return at == winding.end() ? 0 : at->second;
    }
    [[nodiscard]] bool clear(std::uint32_t shell) const { return !unclear.contains(shell); }
  };

  const Position& position(std::uint32_t c) {
    const auto [at, fresh] = positions_.try_emplace(c);
    if (fresh) at->second = find_position(c);
    return at->second;
  }

  Position find_position(std::uint32_t c) const {
    Position out;
    bool near = false;
    for (std::uint32_t d = 0; d < box_.size() && !near; ++d)
      near = d != c && chains_.closed[d] != 0 && overlap(box_[c], box_[d]);
    if (!near) return out;
    std::set<std::uint32_t> touched;
    for (const std::uint32_t t : members_[c]) {
      Box3 box;
      for (int k = 0; k < 3; ++k) box.extend(corner(t, k));
      bvh_->traverse([&](const Box3& b) { return overlap(b, box); },
                     [&](std::uint32_t u) {
                       const std::uint32_t d = chains_.label[u];
                       if (d == c || chains_.closed[d] == 0 || out.unclear.contains(d)) return;
                       const Triangle &x = mesh_.triangles[t], &y = mesh_.triangles[u];
                       if (std::find_first_of(x.begin(), x.end(), y.begin(), y.end()) != x.end())
                         touched.insert(d);
                       if (meet_improperly(mesh_, t, u)) out.unclear.insert(d);
                     });
    }
    // Only corners and edges are common: the winding number of another shell is the same all over
    // the inside of a triangle, and at those of its corners that are not on that shell.
    std::map<std::uint32_t, std::map<std::uint32_t, int>> at_vertex;
    const auto windings = [&](std::uint32_t v) -> const std::map<std::uint32_t, int>& {
      const auto entry = at_vertex.try_emplace(v);
      std::map<std::uint32_t, int>& numbers = entry.first->second;
      if (!entry.second) return numbers;
      std::set<std::uint32_t> on;
      winding_->crossings(mesh_.vertices[v], [&](std::uint32_t t, int sign) {
        const std::uint32_t d = chains_.label[t];
        if (sign == 0) on.insert(d);
        numbers[d] += sign;
      });
      for (const std::uint32_t d : on) numbers[d] = kOn;
      return numbers;
    };
    for (const auto& [d, w] : windings(mesh_.triangles[members_[c][0]][0])) {
      if (d == c || w == 0 || touched.contains(d)) continue;
      if (w == kOn) {  // where only triangles without area meet
        out.unclear.insert(d);
      } else {
        out.winding.emplace(d, w);
      }
    }
    for (const std::uint32_t d : touched) {
      std::optional<int> all;
      bool same = true;
      for (std::size_t i = 0; i < members_[c].size() && same; ++i) {
        bool decided = false;
        for (const std::uint32_t v : mesh_.triangles[members_[c][i]]) {
          const auto& w = windings(v);
          const auto at = w.find(d);
          const int value = at == w.end() ? 0 : at->second;
          if (value == kOn) continue;
          decided = true;
          same = same && (!all || *all == value);
          all = value;
        }
        same = same && decided;
      }
      if (!same) {
        out.unclear.insert(d);
      } else if (*all != 0) {
        out.winding.emplace(d, *all);
      }
    }
    return out;
  }

  /// The shell that c is a cavity of: it winds round c once, no surface of it or of its other
  /// cavities meets c's but in common corners and edges, and c is in none of those.
  std::optional<std::uint32_t> owner(std::uint32_t c) {
    const Position& p = position(c);
    for (const auto& [d, w] : p.winding) {
      if (sign_[d] <= 0 || !p.clear(d) || w * sense_[d] < 1) continue;
      const std::vector<std::uint32_t>& others = cavities_[d];
      if (std::all_of(others.begin(), others.end(), [&](std::uint32_t e) {
            const Position& q = position(e);
            return p.clear(e) && p.of(e) == 0 && q.clear(c) && q.of(c) == 0;
          }))
        return d;
    }
    return {};
  }

  /// Shells within c that are turned along with it: all of them if they have no solid of their own,
  /// else none.
  std::vector<std::uint32_t> nest_of(std::uint32_t c) {
    std::vector<std::uint32_t> nest{c};
    for (std::uint32_t d = 0; d < sign_.size(); ++d) {
      if (d == c || sign_[d] == 0 || std::abs(chains_.volume[d]) >= std::abs(chains_.volume[c]) ||
          !(box_[d].min.array() >= box_[c].min.array()).all() ||
          !(box_[d].max.array() <= box_[c].max.array()).all())
        continue;
      if (position(d).of(c) != 0 && position(d).clear(c)) nest.push_back(d);
    }
    for (const std::uint32_t d : nest) {
      if (d == c) continue;
      const Position& p = position(d);
      int outside = 0;
      for (const std::uint32_t e : nest) {
        if (e != d && !p.clear(e)) return {c};
        if (e != d) outside += sense_[e] * p.of(e);
      }
      if (outside > 0 || outside + sign_[d] > 0) return {c};
    }
    return nest;
  }

  void turn_shells() {
    const std::size_t count = chains_.closed.size();
    sign_ = chains_.sign;
    sense_.assign(count, 1);
    members_.assign(count, {});
    box_.assign(count, {});
    cavities_.assign(count, {});
    std::vector<char> filled(count, 0);
    for (std::uint32_t t = 0; t < was_open_.size(); ++t)
      if (was_open_[t] != 0) filled[chains_.label[t]] = 1;
    for (std::uint32_t t = 0; t < chains_.label.size(); ++t) {
      members_[chains_.label[t]].push_back(t);
      for (int k = 0; k < 3; ++k) box_[chains_.label[t]].extend(corner(t, k));
    }
    std::vector<std::uint32_t> by_size(count);
    std::iota(by_size.begin(), by_size.end(), 0U);
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::abs(chains_.volume[a]) > std::abs(chains_.volume[b]);
    });
    for (const std::uint32_t c : by_size) {
      if (sign_[c] >= 0) continue;
      // What was open is never a cavity: that would take from a solid that was closed before.
      const auto around = filled[c] != 0 ? std::nullopt : owner(c);
      if (around) {
        cavities_[*around].push_back(c);
        ++out_.cavities;
        continue;
      }
      const std::vector<std::uint32_t> nest = nest_of(c);
      out_.inside_out.push_back(members_[c][0]);
      out_.cavities_turned += nest.size() - 1;
      for (const std::uint32_t d : nest) {
        sense_[d] = -sense_[d];
        sign_[d] = -sign_[d];
      }
    }
    for (std::uint32_t t = 0; t < chains_.label.size(); ++t)
      out_.turn[t] = sense_[chains_.label[t]] < 0 ? 1 : 0;
    for (const Probe& p : doubts_) {
      // Both signs: whichever way the chain is turned, a part is inside out.
      const std::uint32_t c = chains_.label[p.triangle];
      if (out_.left) continue;
      out_.left = {p.triangle, sense_[c] * p.front < 0 ? p.in_front : p.behind, !crosses_itself(c)};
    }
    if (!out_.left) look_everywhere();
  }

  /// Whether a joined chain, or a piece of one, still winds less than 0 times somewhere beside its
  /// triangles, as turned. Faces of two bodies that lie in each other without common corners change
  /// the winding number within a region, so one probe does not speak for all of it. Of large chains
  /// only some triangles are looked at.
  void look_everywhere() {
    constexpr std::size_t kMost = 20'000;
    std::vector<std::int8_t> weight(mesh_.triangles.size(), 0);
    for (std::uint32_t c = 0; c < chains_.closed.size(); ++c) {
      if (chains_.closed[c] == 0 || chains_.joined[c] == 0 || sign_[c] < 0) continue;
      const std::vector<std::uint32_t>& all = members_[c];
      for (const std::uint32_t t : all) weight[t] = static_cast<std::int8_t>(sense_[c]);
      for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / kMost) {
        const Vec3 &p = corner(all[i], 0), &q = corner(all[i], 1), &r = corner(all[i], 2);
        const Vec3 normal = (q - p).cross(r - p);
        const double size = std::sqrt(normal.norm());
        if (!(size > 0)) continue;
        for (const double h : {1e-3, -1e-3, 1e-6, -1e-6}) {
          const Vec3 at = (p + q + r) / 3 + normal * (h / size);
          const std::optional<int> w = winding_->weighted(at, weight);
          if (!w || *w >= 0) continue;
          out_.left = {all[i], at, !crosses_itself(c)};
          return;
        }
      }
      for (const std::uint32_t t : all) weight[t] = 0;
    }
  }

  static constexpr int kOn = std::numeric_limits<int>::min();

  const Mesh& mesh_;
  std::span<const EdgeUse> uses_;
  std::span<const std::uint32_t> was_open_;
  Chains chains_;
  Judgement out_;
  std::shared_ptr<const Bvh> bvh_;
  std::unique_ptr<const WindingNumber> winding_;

  std::vector<std::uint32_t> stack_;   // per triangle of joined chains: the first of its copies
  std::vector<std::uint32_t> copy_;    // its place among the copies
  std::vector<std::uint32_t> region_;  // per triangle of joined chains
  std::vector<Region> regions_;
  std::vector<Probe> doubts_;  // with winding numbers of both signs

  // Per shell, as turned so far.
  std::vector<int> sign_, sense_;
  std::vector<std::vector<std::uint32_t>> members_, cavities_;
  std::vector<Box3> box_;
  std::map<std::uint32_t, Position> positions_;
};

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

Judgement judge_shells(const Mesh& mesh, std::span<const EdgeUse> uses,
                       std::span<const std::uint32_t> was_open) {
  return Judge(mesh, uses, was_open).run();
}

}  // namespace kaboum::geom
