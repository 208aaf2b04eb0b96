#include "margin.h"

#include <kaboum/verify/distance.h>

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nearest.h"
#include "spot.h"

namespace kaboum::verify {
namespace {

constexpr int kClimbs = 200;
constexpr double kNowhere = -std::numeric_limits<double>::infinity();

/// The part Z of the inner solid that is outside the outer one, and how far it is from there.
class Pockets {
 public:
  /// @param offending  faces that Z's boundary lies on; not empty
  Pockets(const Scene& scene, const std::vector<std::uint32_t>& offending, double margin)
      : scene_(scene),
        boundary_(boxes_of(scene, offending), offending),
        margin_(margin),
        slack_(rounding_of_distances(scene.largest_coordinate())) {}

  /// Verified, refuted with a witness, or undecided.
  [[nodiscard]] Claim within_margin(std::size_t max_cells) const {
    Claim claim;
    std::vector<Bounds> cells{boundary_.nodes().front().box}, open;
    std::vector<Look> looks;
    std::size_t seen = 0;
    for (; !cells.empty(); cells.swap(open)) {
      seen += cells.size();
      if (seen > max_cells) {
        claim.answer = Answer::Undecided;
        claim.reason = "what the bodies leave out reaches too close to the margin";
        return claim;
      }
      looks.assign(cells.size(), {});
      oneapi::tbb::parallel_for(std::size_t{0}, cells.size(),
                                [&](std::size_t i) { looks[i] = look_at(cells[i]); });
      const auto deepest =
          std::max_element(looks.begin(), looks.end(),
                           [](const Look& a, const Look& b) { return a.beyond < b.beyond; });
      if (climb(*deepest) > 0) {
        claim.answer = Answer::Refuted;
        claim.reason = "a part of the inner solid is farther from the outer one than the margin";
        claim.witness = Witness{scene_.point_outside(deepest->point),
                                scene_.length_outside(deepest->beyond), true};
        return claim;
      }
      open.clear();
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (!looks[i].settled) halve(cells[i], open);
      }
    }
    claim.answer = Answer::Verified;
    return claim;
  }

 private:
  struct Look {
    bool settled = false;
    Vec3 point = Vec3::Zero();
    /// `point` is in Z, and its distance exceeds the margin by at least this; −∞: not in Z.
    double beyond = kNowhere;
  };

  static std::vector<Bounds> boxes_of(const Scene& scene, const std::vector<std::uint32_t>& faces) {
    std::vector<Bounds> boxes;
    for (const std::uint32_t f : faces) {
      Bounds box;
      for (int k = 0; k < 3; ++k) {
        box.low[k] =
            std::min({scene.corner(f, 0)[k], scene.corner(f, 1)[k], scene.corner(f, 2)[k]});
        box.high[k] =
            std::max({scene.corner(f, 0)[k], scene.corner(f, 1)[k], scene.corner(f, 2)[k]});
      }
      boxes.push_back(box);
    }
    return boxes;
  }

  [[nodiscard]] Look look_at(const Bounds& cell) const {
    // Off the middle, which meshes with round coordinates like to have their planes through.
    static const Vec3 kPlace(0.4877, 0.5131, 0.5023);
    const Vec3 low(cell.low.data()), high(cell.high.data());
    Look look;
    look.point = low + kPlace.cwiseProduct(high - low);
    const double radius = (high - look.point).cwiseMax(look.point - low).norm() + slack_;

    const NearestTriangle outer(scene_, scene_.tree(kOutside));
    const NearestTriangle::Hit hit = outer.nearest(look.point);
    look.settled = hit.distance + slack_ + radius <= margin_ || near(low, high, hit.face);
    if (look.settled) return look;

    const std::optional<bool> in = in_pocket(look.point);
    const NearestTriangle boundary(scene_, boundary_);
    if (in.has_value() && !*in) {
      // Without a triangle of the boundary the box lies outside Z as its middle does.
      const double distance = boundary.nearest(look.point).distance;
      look.settled =
          distance > radius && boundary.lower_bound(look.point, distance) - slack_ > radius;
    } else if (in.has_value()) {
      look.beyond = beyond(look.point, hit.distance);
    }
    return look;
  }

  /// What a point's distance exceeds the margin by at least.
  [[nodiscard]] double beyond(const Vec3& p, double distance) const {
    return NearestTriangle(scene_, kOutside).lower_bound(p, distance) - slack_ - margin_;
  }

  /// Moves the point within Z away from what is nearest, by less and less, while it gets deeper.
  double climb(Look& look) const {
    const NearestTriangle outer(scene_, kOutside);
    double step = std::max(margin_, -look.beyond);
    for (int i = 0; i < kClimbs && look.beyond > kNowhere && step > slack_; ++i) {
      const std::uint32_t f = outer.nearest(look.point).face;
      const Vec3 away = look.point - closest_point(look.point, scene_.corner(f, 0),
                                                   scene_.corner(f, 1), scene_.corner(f, 2));
      if (!(away.norm() > 0)) break;
      const Vec3 next = look.point + step * away.normalized();
      const double reached =
          in_pocket(next).value_or(false) ? beyond(next, outer.distance(next)) : kNowhere;
      if (reached > look.beyond) {
        look.point = next;
        look.beyond = reached;
      } else {
        step /= 2;
      }
    }
    return look.beyond;
  }

  /// Whether all corners, and so the box, are within the margin of one triangle.
  [[nodiscard]] bool near(const Vec3& low, const Vec3& high, std::uint32_t f) const {
    if (f == NearestTriangle::kNone) return false;
    for (int i = 0; i < 8; ++i) {
      const Vec3 p((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                   (i & 4) != 0 ? high.z() : low.z());
      const Vec3 q =
          closest_point(p, scene_.corner(f, 0), scene_.corner(f, 1), scene_.corner(f, 2));
      if ((q - p).norm() + slack_ > margin_) return false;
    }
    return true;
  }

  /// nullopt when the point may lie on a surface.
  [[nodiscard]] std::optional<bool> in_pocket(const Vec3& p) const {
    const std::optional<int> inner = winding_at(scene_, kInside, p);
    if (inner && *inner < 1) return false;
    const std::optional<int> outer = winding_at(scene_, kOutside, p);
    if (outer && *outer >= 1) return false;
    if (!inner || !outer) return std::nullopt;
    return true;
  }

  static void halve(const Bounds& cell, std::vector<Bounds>& into) {
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (cell.high[k] - cell.low[k] > cell.high[axis] - cell.low[axis]) axis = k;
    }
    const double middle = 0.5 * cell.low[axis] + 0.5 * cell.high[axis];
    into.push_back(cell);
    into.back().high[axis] = middle;
    into.push_back(cell);
    into.back().low[axis] = middle;
  }

  const Scene& scene_;
  BoxTree boundary_;
  double margin_;
  double slack_;
};

Claim solid_claim(const Scene& scene, double margin, std::size_t max_cells, const Claim& without) {
  // Faces are numbered without those of repeated corners; a claim names triangles of the meshes.
  std::vector<std::uint32_t> offending;
  for (const int chain : {kInside, kOutside}) {
    const std::vector<std::uint32_t>& named =
        chain == kInside ? without.inner_triangles : without.outer_triangles;
    for (std::uint32_t f = scene.begin(chain); f < scene.end(chain); ++f) {
      if (std::binary_search(named.begin(), named.end(), scene.face(f).source)) {
        offending.push_back(f);
      }
    }
  }
  return Pockets(scene, offending, margin * scene.scale()).within_margin(max_cells);
}

Claim surface_claim(const geom::Mesh& inner, const geom::Mesh& outer, double margin,
                    const Claim& without) {
  geom::Mesh part{inner.vertices, {}};
  for (const std::uint32_t t : without.inner_triangles) {
    part.triangles.push_back(inner.triangles[t]);
  }
  DistanceClaimOptions options;
  options.to_solid = true;
  const DistanceClaim distance = verify_distance(part, outer, margin, options);
  Claim claim;
  claim.answer = distance.answer;
  claim.reason = distance.reason;
  if (distance.answer == Answer::Refuted) {
    claim.reason = "a triangle is farther from the outer solid than the margin";
    claim.witness = Witness{distance.at, distance.largest - margin, false};
  }
  return claim;
}

}  // namespace

void allow_margin(const geom::Mesh& inner, const geom::Mesh& outer, double margin,
                  std::size_t max_cells, Inclusion& inclusion) {
  const Scene scene(inner, outer);
  if (scene.tree(kOutside).empty()) return;  // nothing to be near
  const auto decide = [&](Claim& claim, const auto& anew) {
    if (claim.answer != Answer::Refuted) return;
    Claim with;
    with.answer = Answer::Undecided;
    if (inclusion.limited) {
      with.reason = "not all that is left out was found within the limits";
    } else if (!scene.scaled()) {
      with.reason = "coordinates span too many orders of magnitude to measure distances";
    } else {
      with = anew(claim);
    }
    if (with.answer == Answer::Refuted) {
      with.inner_triangles = std::move(claim.inner_triangles);
      with.outer_triangles = std::move(claim.outer_triangles);
    }
    claim = std::move(with);
  };
  if (!inclusion.relative) {
    decide(inclusion.solid,
           [&](const Claim& c) { return solid_claim(scene, margin, max_cells, c); });
  }
  decide(inclusion.surface, [&](const Claim& c) { return surface_claim(inner, outer, margin, c); });
}

}  // namespace kaboum::verify
