// Polytopes with few facets round points.

#include "facet_hull.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/facets.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "float32_below.h"
#include "outward.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using geom::Triangle;
using geom::Vec3;

// Constants of the search. No claim rests on them: exact orientation tests decide the result.

/// Planes that the search begins with, for each facet that is allowed, and at least.
constexpr std::size_t kPlanesPerFacet = 3, kFewestPlanes = 96;
/// Most that are left out, and most facets whose planes are turned: more take long and gain nothing
/// that matters.
constexpr std::size_t kMostLeftOut = 128, kMostTurned = 64;
/// Facets whose normals are nearer than this are one. [radians]
constexpr double kSameNormal = 1e-6;
/// A plane is turned by this share of the way from where it touches to its facet's middle, over the
/// size of the body; by more after a step that helped, by less after one that did not.
constexpr double kFirstTurn = 0.5, kLongerTurn = 1.5, kShorterTurn = 0.4, kLeastTurn = 1e-3;
constexpr int kTurnRounds = 30;
/// Beyond so many facets exchanges take long and gain nothing that matters.
constexpr std::size_t kMostExchanged = 32;
/// Least share of the volume that a step has to save.
constexpr double kGain = 1e-6, kExchangeGain = 1e-4;
/// Margins of the planes for rounding, doubled from the first on. [float32 spacings]
constexpr double kFirstMargin = 2, kLastMargin = 1e4;

/// The half-space {normal · x ≤ height}, |normal| = 1, height > 0.
struct TangentPlane {
  Vec3 normal;
  double height;
};

/// The intersection of half-spaces that all have the origin in their inside: its corners are the
/// facets of the hull of the points normal / height.
class Intersection {
 public:
  /// @return false when it is not bounded.
  bool build(const std::vector<TangentPlane>& planes) {
    planes_ = &planes;
    duals_.clear();
    for (const TangentPlane& p : planes) duals_.push_back(p.normal / p.height);
    corners_.clear();
    if (!builder_.build(duals_)) return false;
    for (const auto& [a, b, c] : builder_.triangles()) {
      const Vec3 n = (duals_[b] - duals_[a]).cross(duals_[c] - duals_[a]);
      const double h = n.dot(duals_[a]);
      if (!(h > 0)) return false;
      corners_.push_back(n / h);
    }
    return corners_.empty() ||
           std::ranges::all_of(corners_, [](const Vec3& p) { return p.allFinite(); });
  }

  [[nodiscard]] const std::vector<Vec3>& corners() const { return corners_; }

  /// Areas and middles of the facets, by plane; what has no facet has the area 0.
  struct Facet {
    double area = 0;
    Vec3 middle = Vec3::Zero();
  };
  /// @return the volume; infinite where rounding leaves none
  double measure(std::vector<Facet>& facets) {
    const std::size_t n = planes_->size();
    facets.assign(n, {});
    // The triangle beyond each directed edge.
    across_.resize(n * n);
    const std::vector<Triangle>& triangles = builder_.triangles();
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) across_[triangles[t][k] * n + triangles[t][(k + 1) % 3]] = t;
    double volume = 0;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        // From this corner to the next one round plane i.
        const std::uint32_t i = triangles[t][k], j = triangles[t][(k + 2) % 3];
        const TangentPlane& plane = (*planes_)[i];
        const Vec3 foot = plane.height * plane.normal;
        const Vec3 &from = corners_[t], &to = corners_[across_[i * n + j]];
        const double area = 0.5 * plane.normal.dot((from - foot).cross(to - foot));
        facets[i].area += area;
        facets[i].middle += area / 3 * (foot + from + to);
        volume += area * plane.height / 3;
      }
    }
    for (Facet& f : facets)
      if (f.area > 0) f.middle /= f.area;
    return volume > 0 ? volume : std::numeric_limits<double>::infinity();
  }

  double volume_of(const std::vector<TangentPlane>& planes) {
    if (!build(planes)) return std::numeric_limits<double>::infinity();
    return measure(facets_);
  }

  /// Planes that are beside plane i.
  [[nodiscard]] std::vector<std::uint32_t> neighbours(std::uint32_t i) const {
    std::vector<std::uint32_t> out;
    for (const Triangle& t : builder_.triangles())
      for (int k = 0; k < 3; ++k)
        if (t[k] == i) out.push_back(t[(k + 1) % 3]);
    return out;
  }

 private:
  const std::vector<TangentPlane>* planes_ = nullptr;
  geom::HullBuilder builder_;
  std::vector<Vec3> duals_, corners_;
  std::vector<std::uint32_t> across_;
  std::vector<Facet> facets_;
};

/// The search for few planes that touch the hull of points.
class PlaneSearch {
 public:
  /// @param points  corners of their hull, whose inside holds the origin
  PlaneSearch(const Mesh& hull, std::size_t most) : points_(hull.vertices), most_(most) {
    for (const Vec3& p : points_) size_ = std::max(size_, p.norm());
    planes_ = touching(hull);
  }

  /// Empty where the hull is too thin for rounded planes to bound it.
  std::vector<TangentPlane> few(PlaneSteps steps) {
    all_ = planes_;
    ensure_built();
    if (volume_ == kInfinity) return {};
    leave_out();
    if (volume_ == kInfinity) return {};
    if (steps != PlaneSteps::Removal && most_ <= kMostTurned) turn();
    if (steps == PlaneSteps::Exchange && most_ <= kMostExchanged) exchange();
    return planes_;
  }

 private:
  [[nodiscard]] const Vec3& farthest(const Vec3& along) const {
    const Vec3* best = points_.data();
    double most = along.dot(*best);
    for (const Vec3& p : points_) {
      const double at = along.dot(p);
      if (at <= most) continue;
      most = at;
      best = &p;
    }
    return *best;
  }
  [[nodiscard]] TangentPlane touching(const Vec3& normal) const {
    return {normal, normal.dot(farthest(normal))};
  }

  /// Planes that touch the hull: of its facets; where these are very many, of the largest whose
  /// normals are not near to each other's.
  [[nodiscard]] std::vector<TangentPlane> touching(const Mesh& hull) const {
    struct Facet {
      Vec3 normal;
      double area;
    };
    std::vector<Facet> facets;
    for (const auto& [a, b, c] : hull.triangles) {
      const Vec3 n = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
      const double area = n.norm();
      if (area > 0) facets.push_back({n / area, area});
    }
    std::ranges::stable_sort(facets,
                             [](const Facet& x, const Facet& y) { return x.area > y.area; });
    const std::size_t enough =
        std::max(kFewestPlanes, std::min(kPlanesPerFacet * most_, most_ + kMostLeftOut));
    std::vector<TangentPlane> out;
    for (double angle = kSameNormal;; angle *= angle < 1e-3 ? 10 : 1.3) {
      out.clear();
      const double near = std::cos(angle);
      for (const Facet& f : facets) {
        if (std::ranges::any_of(out, [&](const TangentPlane& p) {
              return angle < 1e-3 ? (p.normal - f.normal).norm() < angle
                                  : p.normal.dot(f.normal) > near;
            }))
          continue;
        out.push_back(touching(f.normal));
        if (out.size() > enough) break;
      }
      if (out.size() <= enough) return out;
    }
  }

  /// Leaves out planes while there are too many, the cheapest first.
  void leave_out() {
    std::vector<double> cost(planes_.size(), -1);  // of leaving it out; below 0: not known
    while (planes_.size() > most_) {
      ensure_built();
      std::vector<TangentPlane> without;
      std::size_t cheapest = 0;
      for (std::size_t i = 0; i < planes_.size(); ++i) {
        if (cost[i] < 0) {
          without = planes_;
          without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
          cost[i] = other_.volume_of(without) - volume_;
          // A plane without a facet costs nothing, up to rounding.
          cost[i] = std::max(cost[i], 0.0);
        }
        if (cost[i] < cost[cheapest]) cheapest = i;
      }
      // Its neighbours cost more without it.
      for (const std::uint32_t i : now_.neighbours(static_cast<std::uint32_t>(cheapest)))
        cost[i] = -1;
      planes_.erase(planes_.begin() + static_cast<std::ptrdiff_t>(cheapest));
      cost.erase(cost.begin() + static_cast<std::ptrdiff_t>(cheapest));
    }
    ensure_built();
  }

  void ensure_built() { volume_ = now_.build(planes_) ? now_.measure(facets_) : kInfinity; }

  /// Turns each plane about the point where it touches, towards its facet's middle: to first order,
  /// turning a plane by the angle δ about a point v changes the volume by −area (middle − v) · δ.
  void turn() {
    std::vector<double> step(planes_.size(), kFirstTurn);
    for (int round = 0; round < kTurnRounds; ++round) {
      const double before = volume_;
      bool any = false;
      for (std::size_t i = 0; i < planes_.size(); ++i) {
        if (step[i] < kLeastTurn || !(facets_[i].area > 0)) continue;
        any = true;
        const Vec3 normal = planes_[i].normal;
        Vec3 way = facets_[i].middle - farthest(normal);
        way -= way.dot(normal) * normal;
        const TangentPlane old = planes_[i];
        planes_[i] = touching(Vec3((normal + step[i] / size_ * way).normalized()));
        if (other_.volume_of(planes_) < (1 - kGain) * volume_) {
          ensure_built();
          step[i] = std::min(step[i] * kLongerTurn, 2.0);
        } else {
          planes_[i] = old;
          step[i] *= kShorterTurn;
        }
      }
      if (!any || !(volume_ < (1 - kGain) * before)) break;
    }
    ensure_built();
  }

  /// Exchanges planes for others that touch, while that makes the volume smaller: first the plane
  /// that costs least to be left out, then the next one, and so on.
  void exchange() {
    bool better = true;
    while (better) {
      better = false;
      for (const std::size_t i : by_cost()) {
        better = exchange(i);
        if (better) break;
      }
    }
    turn();
  }

  /// Planes by the volume without them, the least first.
  std::vector<std::size_t> by_cost() {
    std::vector<double> without(planes_.size());
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      std::vector<TangentPlane> others = planes_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      without[i] = other_.volume_of(others);
    }
    std::vector<std::size_t> out(planes_.size());
    std::iota(out.begin(), out.end(), std::size_t{0});
    std::ranges::stable_sort(out,
                             [&](std::size_t a, std::size_t b) { return without[a] < without[b]; });
    return out;
  }

  /// @return whether there is a better plane instead of plane i.
  bool exchange(std::size_t i) {
    TangentPlane best = planes_[i];
    double smallest = (1 - kExchangeGain) * volume_;
    bool better = false;
    for (const TangentPlane& plane : all_) {
      planes_[i] = plane;
      const double with = other_.volume_of(planes_);
      if (with >= smallest) continue;
      smallest = with;
      best = plane;
      better = true;
    }
    planes_[i] = best;
    ensure_built();
    return better;
  }

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<Vec3>& points_;
  std::size_t most_;
  double size_ = 0, volume_ = 0;
  std::vector<TangentPlane> planes_, all_;
  Intersection now_, other_;
  std::vector<Intersection::Facet> facets_;
};

bool holds(const std::vector<Vec3>& corners, const std::vector<Triangle>& facets,
           std::span<const Vec3> required) {
  for (const auto& [a, b, c] : facets)
    for (const Vec3& p : required)
      if (geom::orient3d(corners[a], corners[b], corners[c], p) == geom::Sign::Positive)
        return false;
  return true;
}

/// A prism or a box round points that are too thin or too flat for planes, along axes of their own
/// if possible.
Mesh prism_or_box(std::span<const Vec3> required, std::size_t most, double ulp) {
  for (const std::size_t corners : {2 * (most - 2), std::size_t{8}}) {
    std::optional<Mesh> prism = prism_round(required, corners);
    if (prism && geom::float32_facet_count(*prism) <= most) return *std::move(prism);
  }
  geom::Box3 box;
  for (const Vec3& p : required) box.extend(p);
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    Vec3& p = corners.emplace_back();
    for (int k = 0; k < 3; ++k)
      p[k] = (i >> k & 1) != 0 ? float32_above(box.max[k] + ulp) : float32_below(box.min[k] - ulp);
  }
  std::optional<Mesh> hull = geom::convex_hull(corners);
  ensure(hull.has_value(), "a box without a hull");
  return *std::move(hull);
}

}  // namespace

Mesh facet_hull(std::span<const Vec3> required, std::size_t facets, std::size_t vertices,
                PlaneSteps steps) {
  // Of F facets a polytope has 2 F − 4 corners at most.
  const std::size_t most = std::min(facets, (vertices + 4) / 2);
  double magnitude = 0;
  for (const Vec3& p : required) magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  if (!(magnitude < 1e38))
    throw Error(ErrorCode::LimitReached, "coordinates beyond float32; scale the mesh");
  const double ulp = geom::float32_spacing(magnitude);
  geom::HullBuilder builder;
  if (!builder.build(required)) return prism_or_box(required, most, ulp);
  Mesh hull = builder.mesh();
  const auto fits = [&](const Mesh& mesh) {
    return mesh.vertices.size() <= vertices && geom::float32_facet_count(mesh) <= facets;
  };
  if (fits(hull)) return hull;
  const std::vector<Vec3> own = hull.vertices;
  Vec3 center = Vec3::Zero();
  for (const Vec3& p : own) center += p / static_cast<double>(own.size());
  for (Vec3& p : hull.vertices) p -= center;
  PlaneSearch search(hull, most);
  const std::vector<TangentPlane> planes = search.few(steps);
  const bool thin = planes.empty() || std::ranges::any_of(planes, [&](const TangentPlane& p) {
                      return !(p.height > ulp);
                    });
  Intersection corners;
  for (double margin = kFirstMargin * ulp; !thin && margin < kLastMargin * ulp; margin *= 2) {
    std::vector<TangentPlane> moved = planes;
    for (TangentPlane& p : moved) p.height += margin;
    if (!corners.build(moved)) break;
    std::vector<Vec3> rounded;
    for (const Vec3& p : corners.corners()) rounded.push_back(geom::to_float32(Vec3(p + center)));
    if (!builder.build(rounded) || !holds(rounded, builder.triangles(), own)) continue;
    Mesh out = builder.mesh();
    if (fits(out)) return out;
  }
  return prism_or_box(own, most, ulp);
}

}  // namespace kaboum::bcd
