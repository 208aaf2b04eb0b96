// Uncovered regions: how far the part of one solid that is outside the other reaches, decided box
// by box. docs/algorithms/exact-inclusion.md, "Uncovered regions".
#include "uncovered_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "free_parts.h"
#include "local_maximum.h"
#include "nearest.h"
#include "parallel.h"
#include "prism_cuts.h"
#include "region_search.h"
#include "tetrahedra.h"

namespace kaboum::verify {
namespace {

constexpr int kClimbs = 200;
// What a box takes, and trying to cut it along bodies, in parts.
constexpr std::size_t kBoxWork = 8, kBodiesWork = 8;
constexpr double kSoon = 4;  // radii of boxes, in what distances are below the limit
constexpr double kNowhere = -std::numeric_limits<double>::infinity();

/// Corners of a box.
std::vector<Vec3> corners(const Bounds& box) {
  std::vector<Vec3> points;
  for (unsigned i = 0; i < 8; ++i)
    points.emplace_back((i & 1U) != 0 ? box.high[0] : box.low[0],
                        (i & 2U) != 0 ? box.high[1] : box.low[1],
                        (i & 4U) != 0 ? box.high[2] : box.low[2]);
  return points;
}

/// Halves boxes until each of them is decided.
class BoxSearch {
 public:
  BoxSearch(const MeshPair& meshes, const std::vector<std::uint32_t>& offending, const Limit& limit)
      : search_(meshes, offending, limit) {}

  /// Verified, refuted with a witness, or undecided.
  [[nodiscard]] Claim within_limit() const {
    Claim claim;
    std::vector<Bounds> cells{search_.boundary.nodes().front().box}, open;
    std::vector<BoxResult> looks;
    std::size_t seen = 0, work = 0;
    for (; !cells.empty(); cells.swap(open)) {
      seen += cells.size();
      if (seen > search_.limit.max_cells || work > search_.limit.max_work) {
        claim.answer = Answer::Undecided;
        claim.reason =
            "not decided within the work allowed, " + std::to_string(seen - cells.size()) +
            " boxes looked at; the largest distance may be close to the limit, and a slightly "
            "larger one be decided";
        return claim;
      }
      looks.assign(cells.size(), {});
      verify::parallel_for(std::size_t{0}, cells.size(),
                           [&](std::size_t i) { looks[i] = look_at(cells[i]); });
      const auto deepest = std::max_element(
          looks.begin(), looks.end(),
          [](const BoxResult& a, const BoxResult& b) { return a.beyond < b.beyond; });
      if (climb(*deepest) > 0) {
        claim.answer = Answer::Refuted;
        claim.witness = Witness{search_.meshes.point_outside(deepest->point),
                                search_.meshes.length_outside(deepest->beyond), true};
        return claim;
      }
      open.clear();
      for (std::size_t i = 0; i < cells.size(); ++i) {
        work += looks[i].work;
        if (looks[i].decided) continue;
        if (diagonal_of(cells[i]) <= search_.slack) {
          claim.answer = Answer::Undecided;
          claim.reason =
              "the largest distance is the limit, but for rounding, as far as can be told; a "
              "slightly larger one may be decided";
          return claim;
        }
        halve(cells[i], open);
      }
    }
    claim.answer = Answer::Verified;
    return claim;
  }

 private:
  struct BoxResult {
    bool decided = false;
    Vec3 point = Vec3::Zero();
    /// `point` is in Z, and its distance exceeds the limit by at least this; −∞: not in Z.
    double beyond = kNowhere;
    std::size_t work = kBoxWork;
  };

  [[nodiscard]] BoxResult look_at(const Bounds& cell) const {
    // Off the middle, which meshes with round coordinates like to have their planes through.
    static const Vec3 kPlace(0.4877, 0.5131, 0.5023);
    const Vec3 low(cell.low.data()), high(cell.high.data());
    BoxResult look;
    look.point = low + kPlace.cwiseProduct(high - low);
    const double radius = (high - look.point).cwiseMax(look.point - low).norm() + search_.slack;

    const NearestTriangle target(search_.limit.triangles, search_.limit.target);
    const NearestTriangle::Hit hit = target.nearest(look.point);
    look.decided = hit.distance + search_.slack + radius <= search_.limit.distance ||
                   search_.near(corners(cell), hit.face);
    if (!look.decided && search_.limit.bodies != nullptr)
      look.decided = search_.limit.bodies->one_holds(cell);
    if (!look.decided && search_.limit.to_outside) look.decided = near_outside(look.point, radius);
    if (look.decided) return look;

    const std::optional<bool> in = search_.in_region(look.point);
    if (in.has_value() && !*in) {
      // The box lies outside Z as its point does without a triangle of Z's boundary, or of the
      // chain that the point is on the wrong side of.
      const auto clear = [&](const BoxTree& tree) {
        return NearestTriangle(search_.meshes, tree).all_beyond(look.point, radius + search_.slack);
      };
      look.decided = clear(search_.boundary) ||
                     (winding_at(search_.meshes, kOutside, look.point).value_or(0) >= 1 &&
                      clear(search_.meshes.tree(kOutside))) ||
                     (winding_at(search_.meshes, kInside, look.point).value_or(1) < 1 &&
                      clear(search_.meshes.tree(kInside)));
    } else if (in.has_value()) {
      look.beyond = beyond(look.point);
    }
    if (!look.decided && search_.limit.inside_only) {
      look.decided = no_maximum(search_, look.point, radius, hit.distance);
    }
    // Where a few halvings will do, cutting costs more than they.
    const bool soon = radius <= kSoon * (search_.limit.distance - hit.distance);
    if (!look.decided && search_.limit.bodies != nullptr)
      look.decided = left_by_bodies(cell, hit.face, look.work);
    if (!look.decided && !soon)
      look.decided = near_without_free(search_, cell, look.point, hit.face, look.work);
    return look;
  }

  /// Whether some point outside the inner solid is within the limit of the whole ball: its centre,
  /// or a point beyond the face nearest to that.
  [[nodiscard]] bool near_outside(const Vec3& p, double radius) const {
    const auto outside = [&](const Vec3& x) {
      return winding_at(search_.meshes, kInside, x).value_or(1) < 1;
    };
    if (radius > search_.limit.distance) return false;
    if (outside(p)) return true;
    const NearestTriangle::Hit hit = NearestTriangle(search_.meshes, kInside).nearest(p);
    const double left = search_.limit.distance - radius - hit.distance;
    if (!(left > 4 * search_.slack) || !(hit.distance > 0)) return false;
    const Vec3 way = (search_.closest(p, hit.face) - p) / hit.distance;
    const Vec3 beyond_it = p + (hit.distance + std::min(left / 2, hit.distance / 16)) * way;
    return (beyond_it - p).norm() + search_.slack + radius <= search_.limit.distance &&
           outside(beyond_it);
  }

  /// What a point's distance exceeds the limit by at least.
  [[nodiscard]] double beyond(const Vec3& p) const {
    const NearestTriangle all(search_.limit.triangles, search_.limit.all);
    return all.lower_bound(p, all.distance(p)) - search_.slack - search_.limit.distance;
  }

  /// Moves the point within Z away from what is nearest, by less and less, while it gets deeper.
  double climb(BoxResult& look) const {
    const NearestTriangle target(search_.limit.triangles, search_.limit.all);
    double step = std::max(search_.limit.distance, -look.beyond);
    for (int i = 0; i < kClimbs && look.beyond > kNowhere && step > search_.slack; ++i) {
      const std::uint32_t f = target.nearest(look.point).face;
      const Vec3 away = look.point - search_.closest(look.point, f);
      if (!(away.norm() > 0)) break;
      const Vec3 next = look.point + step * away.normalized();
      const double reached = search_.in_region(next).value_or(false) ? beyond(next) : kNowhere;
      if (reached > look.beyond) {
        look.point = next;
        look.beyond = reached;
      } else {
        step /= 2;
      }
    }
    return look.beyond;
  }

  /// Whether all that the bodies leave of the box is within the limit.
  [[nodiscard]] bool left_by_bodies(const Bounds& cell, std::uint32_t face,
                                    std::size_t& work) const {
    work += kBodiesWork;
    std::vector<Part> parts;
    if (!search_.limit.bodies->parts(cell, parts)) return false;
    return near_after_cuts(search_, parts, face, work);
  }

  RegionSearch search_;
};

}  // namespace

bool RegionSearch::near(const std::vector<Vec3>& points, std::uint32_t f) const {
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
    const Vec3 q = closest_point(p, limit.triangles.corner(f, 0), limit.triangles.corner(f, 1),
                                 limit.triangles.corner(f, 2));
    return (q - p).norm() + slack <= limit.distance;
  });
}

BoxTree tree_of(const Triangles& triangles, const std::vector<std::uint32_t>& chosen) {
  std::vector<Bounds> boxes;
  boxes.reserve(chosen.size());
  for (const std::uint32_t t : chosen) {
    const Vec3 &a = triangles.corner(t, 0), &b = triangles.corner(t, 1),
               &c = triangles.corner(t, 2);
    Bounds box;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = std::min({a[k], b[k], c[k]});
      box.high[k] = std::max({a[k], b[k], c[k]});
    }
    boxes.push_back(box);
  }
  return {std::move(boxes), chosen};
}

std::vector<std::uint32_t> offending_faces(const MeshPair& meshes, const Claim& claim) {
  // Faces are numbered without those of repeated corners; a claim names triangles of the meshes.
  std::vector<std::uint32_t> faces;
  for (const int chain : {kInside, kOutside}) {
    const std::vector<std::uint32_t>& named =
        chain == kInside ? claim.inner_triangles : claim.outer_triangles;
    const auto first = static_cast<std::ptrdiff_t>(faces.size());
    for (std::uint32_t f = meshes.begin(chain); f < meshes.end(chain); ++f) {
      if (std::binary_search(named.begin(), named.end(), meshes.face(f).source)) faces.push_back(f);
    }
    std::sort(faces.begin() + first, faces.end(), [&](std::uint32_t f, std::uint32_t g) {
      return meshes.face(f).source < meshes.face(g).source;
    });
  }
  return faces;
}

Claim search_uncovered(const MeshPair& meshes, const std::vector<std::uint32_t>& offending,
                       const Limit& limit) {
  return BoxSearch(meshes, offending, limit).within_limit();
}

}  // namespace kaboum::verify
