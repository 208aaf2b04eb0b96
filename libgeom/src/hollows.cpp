// Hollows between parts that share edges. A surface may be any integer combination of triangles
// without border; those of a part are the kernel of its boundary operator. A random element of the
// kernel winds round a point 0 times only if all of them do, but for a chance of 2^-61.
#include <kaboum/geom/bvh.h>
#include <kaboum/geom/hollows.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "union_find.h"

namespace kaboum::geom {
namespace {

/// Integers modulo the prime 2^61 − 1.
class Residue {
 public:
  static constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;

  Residue() = default;
  explicit Residue(std::int64_t x)
      : value_(x < 0 ? kPrime - static_cast<std::uint64_t>(-x) : static_cast<std::uint64_t>(x)) {}

  [[nodiscard]] bool zero() const { return value_ == 0; }
  [[nodiscard]] Residue inverse() const {
    Residue out(1), base = *this;
    for (std::uint64_t e = kPrime - 2; e != 0; e >>= 1) {
      if ((e & 1) != 0) out = out * base;
      base = base * base;
    }
    return out;
  }
  friend Residue operator+(Residue a, Residue b) {
    a.value_ += b.value_;
    if (a.value_ >= kPrime) a.value_ -= kPrime;
    return a;
  }
  friend Residue operator-(Residue a) {
    a.value_ = a.value_ == 0 ? 0 : kPrime - a.value_;
    return a;
  }
  friend Residue operator*(Residue a, Residue b) {
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(a.value_) * b.value_;
    Residue low, high;
    low.value_ = static_cast<std::uint64_t>(product) & kPrime;
    high.value_ = static_cast<std::uint64_t>(product >> 61);
    if (low.value_ == kPrime) low.value_ = 0;
    return low + high;
  }
  friend bool operator==(Residue a, Residue b) { return a.value_ == b.value_; }
  friend bool operator<(Residue a, Residue b) { return a.value_ < b.value_; }

 private:
  std::uint64_t value_ = 0;
};

/// A homogeneous equation: unknown → factor, not 0.
using Equation = std::map<std::uint32_t, Residue>;

void add(Equation& to, const Equation& from, Residue factor) {
  for (const auto& [unknown, value] : from) {
    Residue& sum = to[unknown];
    sum = sum + value * factor;
    if (sum.zero()) to.erase(unknown);
  }
}

class Hollows {
 public:
  explicit Hollows(const Mesh& walls)
      : mesh_(walls), uses_(edge_uses(walls)), sign_(walls.triangles.size(), 1) {}

  std::optional<Hollow> find() {
    if (!join_patches()) return {};
    find_parts();
    solve();
    return look();
  }

 private:
  /// Triangles at edges of two have the same factor, or opposite ones where they disagree.
  /// @return whether there are other edges of more.
  bool join_patches() {
    const std::size_t n = mesh_.triangles.size();
    std::vector<std::vector<std::pair<std::uint32_t, int>>> across(n);
    bool branched = false;
    for_each_edge(uses_, [&](std::span<const EdgeUse> e) {
      branched = branched || e.size() > 2;
      if (e.size() != 2) return;
      const int same = e[0].forward != e[1].forward ? 1 : -1;
      across[e[0].triangle].emplace_back(e[1].triangle, same);
      across[e[1].triangle].emplace_back(e[0].triangle, same);
    });
    if (!branched) return false;
    patch_.assign(n, kNone);
    std::vector<std::uint32_t> stack;
    for (std::uint32_t seed = 0; seed < n; ++seed) {
      if (patch_[seed] != kNone) continue;
      const auto patch = static_cast<std::uint32_t>(factor_.size());
      factor_.emplace_back();
      nothing_.push_back(0);
      patch_[seed] = patch;
      stack.assign(1, seed);
      while (!stack.empty()) {
        const std::uint32_t t = stack.back();
        stack.pop_back();
        for (const auto& [u, same] : across[t]) {
          if (patch_[u] == kNone) {
            patch_[u] = patch;
            sign_[u] = sign_[t] * same;
            stack.push_back(u);
          } else if (sign_[u] != sign_[t] * same) {
            nothing_[patch] = 1;  // one-sided
          }
        }
      }
    }
    return true;
  }

  /// Parts: patches that share edges.
  void find_parts() {
    UnionFind sets(factor_.size());
    for_each_edge(uses_, [&](std::span<const EdgeUse> e) {
      for (const EdgeUse& u : e) sets.join(patch_[e[0].triangle], patch_[u.triangle]);
    });
    std::uint32_t count = 0;
    part_ = sets.labels(&count);
    ways_.assign(count, 0);
    members_.assign(count, {});
    for (std::uint32_t t = 0; t < patch_.size(); ++t) members_[part_[patch_[t]]].push_back(t);
  }

  /// Draws factors under which no edge has a border, and counts the ways to choose them.
  void solve() {
    std::set<Equation> equations;
    for (std::uint32_t p = 0; p < nothing_.size(); ++p)
      if (nothing_[p] != 0) equations.insert({{p, Residue(1)}});
    for_each_edge(uses_, [&](std::span<const EdgeUse> e) {
      if (e.size() == 2) return;
      Equation equation;
      for (const EdgeUse& u : e)
        add(equation, {{patch_[u.triangle], Residue((u.forward ? 1 : -1) * sign_[u.triangle])}},
            Residue(1));
      if (equation.empty()) return;
      const Residue first = equation.begin()->second.inverse();
      for (auto& [unknown, value] : equation) value = value * first;
      equations.insert(std::move(equation));
    });
    // Short ones first: little fills in.
    std::vector<const Equation*> by_size;
    by_size.reserve(equations.size());
    for (const Equation& e : equations) by_size.push_back(&e);
    std::stable_sort(by_size.begin(), by_size.end(),
                     [](const Equation* a, const Equation* b) { return a->size() < b->size(); });
    std::map<std::uint32_t, Equation> solved;  // its last unknown by the ones before, factor 1
    for (const Equation* given : by_size) {
      Equation e = *given;
      while (!e.empty()) {
        const auto last = std::prev(e.end());
        const auto known = solved.find(last->first);
        if (known == solved.end()) {
          const std::uint32_t unknown = last->first;
          const Residue scale = last->second.inverse();
          for (auto& [u, value] : e) value = value * scale;
          solved.emplace(unknown, std::move(e));
          break;
        }
        add(e, known->second, -last->second);
      }
    }
    std::mt19937_64 random(61);
    for (std::uint32_t p = 0; p < factor_.size(); ++p) {
      const auto at = solved.find(p);
      if (at == solved.end()) {
        factor_[p] = Residue(static_cast<std::int64_t>(random() >> 4) + 1);
        ++ways_[part_[p]];
        continue;
      }
      for (const auto& [u, value] : at->second)
        if (u != p) factor_[p] = factor_[p] + -(value * factor_[u]);
    }
  }

  [[nodiscard]] const Vec3& corner(std::uint32_t t, int k) const {
    return mesh_.vertices[mesh_.triangles[t][k]];
  }

  /// Whether p is enclosed by a part, and not in the solid.
  [[nodiscard]] bool hollow(const Vec3& p, std::uint32_t part) const {
    int all = 0, of_part = 0;
    Residue any;
    bool on = false;
    winding_->crossings(p, [&](std::uint32_t t, int crossing) {
      on = on || crossing == 0;
      all += crossing;
      if (part_[patch_[t]] != part) return;
      of_part += crossing;
      any = any + factor_[patch_[t]] * Residue(crossing * sign_[t]);
    });
    return !on && (all < 0 || (all == 0 && of_part == 0 && !any.zero()));
  }

  /// Whether triangles of both senses lie between two points next to each other.
  [[nodiscard]] bool opposite_between(const Vec3& p, const Vec3& q) const {
    Box3 box;
    box.extend(p);
    box.extend(q);
    bool up = false, down = false;
    bvh_->traverse(
        [&](const Box3& b) {
          return (b.min.array() <= box.max.array()).all() &&
                 (box.min.array() <= b.max.array()).all();
        },
        [&](std::uint32_t t) {
          const Vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
          const Sign s = orient3d(a, b, c, p);
          if (s == Sign::Zero ||
              orient3d(a, b, c, q) != (s == Sign::Positive ? Sign::Negative : Sign::Positive))
            return;
          const Sign side = orient3d(p, q, a, b);
          if (side == Sign::Zero || orient3d(p, q, b, c) != side || orient3d(p, q, c, a) != side)
            return;
          (s == Sign::Positive ? up : down) = true;
        });
    return up && down;
  }

  std::optional<Hollow> look() {
    constexpr std::size_t kMost = 20'000, kFew = 2'000;
    std::optional<Hollow> found;
    for (std::uint32_t part = 0; part < ways_.size(); ++part) {
      if (ways_[part] < 2) continue;
      if (!bvh_) {
        bvh_ = std::make_shared<const Bvh>(mesh_);
        winding_ = std::make_unique<const WindingNumber>(mesh_, bvh_);
      }
      const std::vector<std::uint32_t>& all = members_[part];
      const bool few = all.size() <= kFew;
      for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / kMost) {
        const std::uint32_t t = all[i];
        const Vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
        const Vec3 normal = (b - a).cross(c - a);
        const double size = std::sqrt(normal.norm());
        if (!(size > 0)) continue;
        for (std::size_t k = 0; k < (few ? kPlaces.size() : 1); ++k) {
          const Vec3 at = kPlaces[k][0] * a + kPlaces[k][1] * b + kPlaces[k][2] * c;
          for (const double h : {1e-3, 1e-6}) {
            const Vec3 step = normal * (h / size);
            for (const Vec3& p : {Vec3(at + step), Vec3(at - step)}) {
              if (!hollow(p, part)) continue;
              if (opposite_between(at + step, at - step)) return Hollow{t, p, true};
              if (!found) found = Hollow{t, p, false};
            }
            if (!few) break;
          }
        }
      }
    }
    return found;
  }

  static constexpr std::uint32_t kNone = ~0U;
  static constexpr std::array<std::array<double, 3>, 7> kPlaces{{{0.34, 0.35, 0.31},
                                                                 {0.83, 0.09, 0.08},
                                                                 {0.08, 0.83, 0.09},
                                                                 {0.09, 0.08, 0.83},
                                                                 {0.47, 0.46, 0.07},
                                                                 {0.07, 0.47, 0.46},
                                                                 {0.46, 0.07, 0.47}}};

  const Mesh& mesh_;
  std::vector<EdgeUse> uses_;
  std::vector<int> sign_;                            // per triangle, within its patch
  std::vector<std::uint32_t> patch_;                 // per triangle
  std::vector<Residue> factor_;                      // per patch: drawn at random
  std::vector<char> nothing_;                        // per patch: only 0 will do
  std::vector<std::uint32_t> part_;                  // per patch
  std::vector<std::uint32_t> ways_;                  // per part: free factors
  std::vector<std::vector<std::uint32_t>> members_;  // per part: triangles
  std::shared_ptr<const Bvh> bvh_;
  std::unique_ptr<const WindingNumber> winding_;
};

}  // namespace

namespace {

/// Points near the middle of a triangle, on both sides; none of triangles without area.
std::vector<Vec3> places_beside(const Mesh& mesh, std::uint32_t t) {
  const auto& [p, q, r] = mesh.triangles[t];
  const Vec3 &a = mesh.vertices[p], &b = mesh.vertices[q], &c = mesh.vertices[r];
  const Vec3 normal = (b - a).cross(c - a);
  const double size = std::sqrt(normal.norm());
  if (!(size > 0)) return {};
  const Vec3 at = 0.34 * a + 0.35 * b + 0.31 * c, step = normal * (1e-3 / size);
  return {at + step, at - step};
}

}  // namespace

std::optional<Hollow> find_inverted(const Mesh& mesh, const WindingNumber& winding,
                                    std::span<const std::uint32_t> beside,
                                    std::span<const std::uint32_t> part) {
  for (const std::uint32_t t : beside) {
    for (const Vec3& x : places_beside(mesh, t)) {
      int number = 0;
      bool on = false;
      winding.crossings(x, [&](std::uint32_t u, int crossing) {
        if (!part.empty() && part[u] != part[t]) return;
        on = on || crossing == 0;
        number += crossing;
      });
      if (!on && number < 0) return Hollow{t, x, false};
    }
  }
  return {};
}

std::optional<Hollow> find_pocket(const Mesh& mesh, const WindingNumber& winding,
                                  std::span<const std::uint32_t> beside,
                                  std::span<const std::uint32_t> part) {
  struct Part {
    bool forward = false;          // winds round some point so
    std::optional<Hollow> behind;  // the first point outside that it winds round backwards
  };
  std::map<std::uint32_t, Part> parts;
  std::vector<std::uint32_t> order;  // as pockets are found
  for (const std::uint32_t t : beside) {
    for (const Vec3& x : places_beside(mesh, t)) {
      int all = 0, own = 0;
      bool on = false;
      winding.crossings(x, [&](std::uint32_t u, int crossing) {
        on = on || crossing == 0;
        all += crossing;
        if (part[u] == part[t]) own += crossing;
      });
      if (on) continue;
      if (all < 0) return Hollow{t, x, false};
      Part& mine = parts[part[t]];
      mine.forward = mine.forward || own > 0;
      if (all > 0 || own >= 0 || mine.behind) continue;
      mine.behind = Hollow{t, x, false};
      order.push_back(part[t]);
    }
  }
  for (const std::uint32_t p : order)
    if (parts[p].forward) return parts[p].behind;
  return {};
}

std::optional<Hollow> find_hollow(const Mesh& walls) { return Hollows(walls).find(); }

}  // namespace kaboum::geom
