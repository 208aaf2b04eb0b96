// Which shells of a mesh are inside out: a shell oriented inwards is a cavity only if it lies in
// one shell, exactly. docs/algorithms/preparation.md.
#include <kaboum/geom/bvh.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>

#include "chains.h"
#include "levels.h"
#include "shell_position.h"
#include "shells.h"
#include "triangle_contact.h"

namespace kaboum::geom {
namespace {

class ShellJudge {
 public:
  ShellJudge(const Mesh& mesh, std::span<const EdgeUse> uses,
             std::span<const std::uint32_t> was_open)
      : mesh_(mesh),
        uses_(uses),
        was_open_(was_open),
        shells_{mesh, find_chains(mesh, uses, was_open)} {}

  Judgement run() {
    out_.reverse.assign(mesh_.triangles.size(), 0);
    const auto doubtful = [&](std::uint32_t c) {
      return shells_.chains.closed[c] != 0 &&
             (shells_.chains.joined[c] != 0 || shells_.chains.sign[c] < 0);
    };
    std::uint32_t c = 0;
    while (c < shells_.chains.closed.size() && !doubtful(c)) ++c;
    if (c == shells_.chains.closed.size()) return std::move(out_);
    bvh_ = std::make_shared<const Bvh>(mesh_);
    winding_ = std::make_unique<const WindingNumber>(mesh_, bvh_);
    Levels levels = split_levels(mesh_, uses_, std::move(shells_.chains), *bvh_, *winding_);
    shells_.chains = std::move(levels.chains);
    doubts_ = std::move(levels.doubts);
    positions_ = std::make_unique<ShellPositions>(shells_, *bvh_, *winding_);
    turn_shells();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const Vec3& corner(std::uint32_t t, int k) const {
    return mesh_.vertices[mesh_.triangles[t][k]];
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
    for (const std::uint32_t t : shells_.members[c]) {
      Box3 box;
      for (int k = 0; k < 3; ++k) box.extend(corner(t, k));
      bvh_->traverse([&](const Box3& b) { return !found && overlap(b, box); },
                     [&](std::uint32_t u) {
                       found = found || (u > t && shells_.chains.label[u] == c &&
                                         meet_improperly(mesh_, t, u) && !coplanar(t, u));
                     });
      if (found) return true;
    }
    return false;
  }

  /// The shell that c is a cavity of: it winds round c once, no surface of it or of its other
  /// cavities meets c's but in common corners and edges, and c is in none of those.
  std::optional<std::uint32_t> owner(std::uint32_t c) {
    const Position& p = (*positions_)(c);
    for (const auto& [d, w] : p.winding) {
      if (sign_[d] <= 0 || !p.clear(d) || w * sense_[d] < 1) continue;
      const std::vector<std::uint32_t>& others = cavities_[d];
      if (std::all_of(others.begin(), others.end(), [&](std::uint32_t e) {
            const Position& q = (*positions_)(e);
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
      if (d == c || sign_[d] == 0 ||
          std::abs(shells_.chains.volume[d]) >= std::abs(shells_.chains.volume[c]) ||
          !(shells_.box[d].min.array() >= shells_.box[c].min.array()).all() ||
          !(shells_.box[d].max.array() <= shells_.box[c].max.array()).all())
        continue;
      if ((*positions_)(d).of(c) != 0 && (*positions_)(d).clear(c)) nest.push_back(d);
    }
    for (const std::uint32_t d : nest) {
      if (d == c) continue;
      const Position& p = (*positions_)(d);
      int outside = 0;
      for (const std::uint32_t e : nest) {
        if (e != d && !p.clear(e)) return {c};
        if (e != d) outside += sense_[e] * p.of(e);
      }
      if (outside > 0 || outside + sign_[d] > 0) return {c};
    }
    return nest;
  }

  /// Finds each chain's members and box.
  void fill_shells() {
    const std::size_t count = shells_.chains.closed.size();
    shells_.members.assign(count, {});
    shells_.box.assign(count, {});
    for (std::uint32_t t = 0; t < shells_.chains.label.size(); ++t) {
      shells_.members[shells_.chains.label[t]].push_back(t);
      for (int k = 0; k < 3; ++k) shells_.box[shells_.chains.label[t]].extend(corner(t, k));
    }
  }

  void turn_shells() {
    fill_shells();
    const std::size_t count = shells_.chains.closed.size();
    sign_ = shells_.chains.sign;
    sense_.assign(count, 1);
    cavities_.assign(count, {});
    std::vector<char> filled(count, 0);
    for (std::uint32_t t = 0; t < was_open_.size(); ++t)
      if (was_open_[t] != 0) filled[shells_.chains.label[t]] = 1;
    std::vector<std::uint32_t> by_size(count);
    std::iota(by_size.begin(), by_size.end(), 0U);
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::abs(shells_.chains.volume[a]) > std::abs(shells_.chains.volume[b]);
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
      out_.inside_out.push_back(shells_.members[c][0]);
      out_.cavities_reversed += nest.size() - 1;
      for (const std::uint32_t d : nest) {
        sense_[d] = -sense_[d];
        sign_[d] = -sign_[d];
      }
    }
    for (std::uint32_t t = 0; t < shells_.chains.label.size(); ++t)
      out_.reverse[t] = sense_[shells_.chains.label[t]] < 0 ? 1 : 0;
    for (const Probe& p : doubts_) {
      // Both signs: whichever way the chain is turned, a part is inside out.
      const std::uint32_t c = shells_.chains.label[p.triangle];
      if (out_.left) continue;
      out_.left = {p.triangle, sense_[c] * p.front < 0 ? p.in_front : p.behind, !crosses_itself(c)};
    }
    if (!out_.left) look_everywhere();
  }

  /// Whether a joined chain, or a piece of one, still winds less than 0 times somewhere beside its
  /// triangles, as turned. Faces of two bodies that lie in each other without common corners change
  /// the winding number within a region, so one probe does not speak for all of it. Of large chains
  /// only some triangles are looked at, of copies one.
  void look_everywhere() {
    constexpr std::size_t kMaxTriangles = 20'000;
    std::vector<std::int8_t> weight(mesh_.triangles.size(), 0);
    for (std::uint32_t c = 0; c < shells_.chains.closed.size(); ++c) {
      if (shells_.chains.closed[c] == 0 || shells_.chains.joined[c] == 0 || sign_[c] < 0) continue;
      const std::vector<std::uint32_t>& all = shells_.members[c];
      for (const std::uint32_t t : all) weight[t] = static_cast<std::int8_t>(sense_[c]);
      std::set<Triangle> seen;
      for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / kMaxTriangles) {
        Triangle key = mesh_.triangles[all[i]];
        std::sort(key.begin(), key.end());
        if (!seen.insert(key).second) continue;
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

  const Mesh& mesh_;
  std::span<const EdgeUse> uses_;
  std::span<const std::uint32_t> was_open_;
  Shells shells_;
  Judgement out_;
  std::shared_ptr<const Bvh> bvh_;
  std::unique_ptr<const WindingNumber> winding_;
  std::unique_ptr<ShellPositions> positions_;

  std::vector<Probe> doubts_;  // with winding numbers of both signs

  // Per shell, as turned so far.
  std::vector<int> sign_, sense_;
  std::vector<std::vector<std::uint32_t>> cavities_;
};

}  // namespace

Judgement judge_shells(const Mesh& mesh, std::span<const EdgeUse> uses,
                       std::span<const std::uint32_t> was_open) {
  return ShellJudge(mesh, uses, was_open).run();
}

}  // namespace kaboum::geom
