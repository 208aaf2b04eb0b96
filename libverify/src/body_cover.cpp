// Unions of convex bodies against triangles and solids: docs/algorithms/capsules-and-boxes.md.
#include <kaboum/verify/body_cover.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "body_bounds.h"
#include "cell_sample.h"
#include "membership.h"
#include "nearest.h"
#include "number.h"
#include "union_cover.h"

namespace kaboum::verify {
namespace {

using union_cover::Cell;
using union_cover::Corner;
using union_cover::Corners;
using union_cover::Extent;
using union_cover::kSqrt3Up;
using union_cover::largest_of;

constexpr int kTurns = 30;  ///< of a direction that is to rise away from bodies

/// A body, and what is asked for often.
struct Body {
  const geom::ConvexBody* body;
  geom::Box3 box;      ///< holds it
  double largest = 0;  ///< coordinate, radius included
};

std::vector<Body> bodies_of(const geom::ConvexSet& set) {
  std::vector<Body> out;
  out.reserve(set.bodies.size());
  for (const geom::ConvexBody& body : set.bodies) {
    Body one{&body, geom::bounding_box(body), body.radius};
    one.largest = std::max({one.largest, largest_of(one.box.min), largest_of(one.box.max)});
    out.push_back(one);
  }
  return out;
}

/// A point of a core that is about the nearest to a point, with a bracket of the distance.
struct Near {
  Vec3 at;
  double lower, upper;
};

Near nearest_of_core(const Body& one, const Vec3& p) {
  const geom::Mesh& core = one.body->core;
  const std::vector<Vec3>& v = core.vertices;
  Near out{v[0], 0, std::numeric_limits<double>::infinity()};
  const double slack = rounding_of_distances(one.largest + largest_of(p));
  const auto take = [&](const Vec3& q) {
    if (const double away = (p - q).norm(); away < out.upper) {
      out.upper = away;
      out.at = q;
    }
  };
  if (core.triangles.empty()) {
    const Vec3 along = v.back() - v.front();
    const double square = along.squaredNorm();
    take(v.front() +
         (square > 0 ? std::clamp((p - v.front()).dot(along) / square, 0.0, 1.0) : 0.0) * along);
  } else {
    bool inside = true;
    for (const geom::Triangle& t : core.triangles)
      inside = inside && geom::orient3d(v[t[0]], v[t[1]], v[t[2]], p) != Sign::Positive;
    if (inside) return {p, 0, 0};
    for (const geom::Triangle& t : core.triangles)
      take(closest_point(p, v[t[0]], v[t[1]], v[t[2]]));
  }
  // In whatever direction: the plane through the lowest vertex separates.
  const Vec3 normal = (p - out.at) / out.upper;
  if (normal.allFinite()) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& q : v) least = std::min(least, normal.dot(p - q));
    out.lower = std::max(0.0, least - slack);
  }
  out.upper += slack;
  return out;
}

Triple<Exact> exact_point(const Corners& t, const Corner& p) {
  Triple<Exact> out{Exact(0), Exact(0), Exact(0)};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = out[k] + Exact(p.weight[i]) * Exact(t[i][static_cast<Eigen::Index>(k)]);
  return out;
}

/// @param error  of each coordinate of p.at
bool holds(const Body& one, const Corners& t, const Corner& p, double error) {
  for (int k = 0; k < 3; ++k)
    if (p.at[k] < one.box.min[k] - error || p.at[k] > one.box.max[k] + error) return false;
  const bool is_exact = p.weight[0] == 1 || p.weight[1] == 1 || p.weight[2] == 1;
  Triple<Approx> rounded = numbers<Approx>(p.at);
  if (!is_exact)
    for (Approx& x : rounded) x.error = error;
  if (const auto known = contains_as(*one.body, rounded)) return *known;
  return *contains_as(*one.body, exact_point(t, p));
}

/// What decides unions of convex bodies with radii.
class Bodies {
 public:
  static constexpr const char* kOne = "body";
  static constexpr const char* kMany = "bodies";

  explicit Bodies(const geom::ConvexSet& set) : bodies_(bodies_of(set)) {}

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(bodies_.size()); }
  [[nodiscard]] bool holds(std::uint32_t b, const Corners& t, const Corner& c,
                           double largest) const {
    return kaboum::verify::holds(bodies_[b], t, c, error_of(largest));
  }
  [[nodiscard]] bool holds(std::uint32_t b, const Vec3& p) const {
    return contains(*bodies_[b].body, p);
  }

  [[nodiscard]] bool may_meet(std::uint32_t b, const Extent& extent, double largest) const {
    const geom::Box3& body = bodies_[b].box;
    const double error = error_of(largest);
    for (int k = 0; k < 3; ++k)
      if (extent.box.max[k] + error < body.min[k] || extent.box.min[k] - error > body.max[k])
        return false;
    return true;
  }

  [[nodiscard]] bool is_settled(Cell& cell) const {
    const std::vector<Near> near = keep_active(cell);
    return cell.active.size() < 4 || in_one_body(cell, near) || is_rising(cell, near);
  }

 private:
  /// Of the coordinates of a corner.
  static double error_of(double largest) { return 8 * kUnit * largest + kTiny; }

  static double reach_of(const Cell& cell) { return kSqrt3Up * cell.half * kGrowth; }

  /// Leaves out bodies that are farther than another one from all points of the cell.
  /// @return of those that are kept, the nearest points of their cores to the middle
  [[nodiscard]] std::vector<Near> keep_active(Cell& cell) const {
    std::vector<Near> all;
    all.reserve(cell.active.size());
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t b : cell.active) {
      all.push_back(nearest_of_core(bodies_[b], cell.center));
      least = std::min(least, all.back().upper - bodies_[b].body->radius);
    }
    const double most =
        (least + 2 * reach_of(cell)) + 4 * kUnit * (std::abs(least) + 2 * reach_of(cell));
    std::vector<Near> near;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double radius = bodies_[cell.active[i]].body->radius;
      if (all[i].lower - radius > most + 4 * kUnit * (all[i].lower + radius)) continue;
      kept.push_back(cell.active[i]);
      near.push_back(all[i]);
    }
    cell.active = std::move(kept);
    return near;
  }

  [[nodiscard]] bool in_one_body(const Cell& cell, const std::vector<Near>& near) const {
    for (std::size_t i = 0; i < near.size(); ++i) {
      const geom::ConvexBody& body = *bodies_[cell.active[i]].body;
      // Else the farthest corner is not in it, or not all are.
      if (near[i].lower > body.radius) continue;
      if (near[i].upper + reach_of(cell) + 4 * kUnit * (near[i].upper + body.radius) <= body.radius)
        return true;
      bool all = true;
      for (int c = 0; c < 8 && all; ++c) {
        const Vec3 to((c & 1) != 0 ? 1 : -1, (c & 2) != 0 ? 1 : -1, (c & 4) != 0 ? 1 : -1);
        all = contains(body, cell.center + cell.half * to);
      }
      if (all) return true;
    }
    return false;
  }

  /// Directions in which a body's distance may grow at points of the cell outside of it, or what
  /// generates them.
  struct Away {
    std::vector<Vec3> generators;          ///< not scaled
    std::vector<std::uint32_t> triangles;  ///< of which these are the normals
    bool is_cone = false;  ///< of facets' normals; else one vector, known but for `error`
    double error = 0;
  };

  static Triple<Approx> normal_of(const geom::Mesh& core, std::uint32_t t) {
    const auto corner = [&](std::size_t k) {
      return numbers<Approx>(core.vertices[core.triangles[t][k]]);
    };
    return membership::cross(membership::minus(corner(1), corner(0)),
                             membership::minus(corner(2), corner(0)));
  }

  /// With p the nearest point of the core to x, the distance grows along x − p. That moves by no
  /// more than x; and it is in the cone of the normals of facets whose planes p is on.
  [[nodiscard]] Away away_of(const Cell& cell, std::uint32_t b, const Near& near) const {
    const Body& one = bodies_[b];
    const geom::Mesh& core = one.body->core;
    Away out;
    const double gap = std::max(0.0, near.upper - near.lower);
    // How far the nearest point may be from the one found: both are in a convex core.
    const double off = std::sqrt(gap * (2 * near.upper + gap)) * kGrowth +
                       rounding_of_distances(one.largest + largest_of(cell.center));
    const double reach = reach_of(cell);
    if (core.triangles.empty() || near.lower > 3 * reach) {
      out.generators = {cell.center - near.at};
      out.error = reach + off;
      return out;
    }
    out.is_cone = true;
    for (std::uint32_t t = 0; t < core.triangles.size(); ++t) {
      const Triple<Approx> a = numbers<Approx>(core.vertices[core.triangles[t][0]]);
      const Triple<Approx> n = normal_of(core, t);
      const Vec3 normal(n[0].value, n[1].value, n[2].value);
      const double length = (normal.norm() + n[0].error + n[1].error + n[2].error) * kGrowth;
      const Approx height = dot(n, membership::minus(a, numbers<Approx>(near.at)));
      // The plane is farther from all nearest points than they can be from each other.
      if (height.value - height.error > (reach + off) * length * kGrowth) continue;
      out.generators.push_back(normal);
      out.triangles.push_back(t);
    }
    return out;
  }

  /// Whether the direction leads away from the body, everywhere in the cell outside of it.
  [[nodiscard]] bool leads_away(const Vec3& direction, std::uint32_t b, const Away& away) const {
    if (!away.is_cone) {
      const Vec3& w = away.generators[0];
      const double rounding = 16 * kUnit * (direction.norm() * w.norm()) + kTiny;
      return direction.dot(w) - rounding > away.error * direction.norm() * kGrowth;
    }
    const geom::Mesh& core = bodies_[b].body->core;
    return std::ranges::all_of(away.triangles, [&](std::uint32_t t) {
      return sign_of(dot(normal_of(core, t), numbers<Approx>(direction))) ==
             std::optional(Sign::Positive);
    });
  }

  /// There is a direction that leads away from all bodies: none of them is nearest to a local
  /// maximum in the cell.
  [[nodiscard]] bool is_rising(const Cell& cell, const std::vector<Near>& near) const {
    std::vector<Away> all;
    std::vector<std::uint32_t> of;
    std::vector<Vec3> units;
    Vec3 direction = Vec3::Zero();
    for (std::size_t i = 0; i < near.size(); ++i) {
      Away one = away_of(cell, cell.active[i], near[i]);
      // It holds all of the cell, or is nowhere in it nearest with a distance above 0.
      if (one.is_cone && one.generators.empty()) return true;
      for (const Vec3& g : one.generators) {
        const double length = g.norm();
        if (!(length > 0) || !std::isfinite(length)) return false;
        if (!one.is_cone && !(length > one.error)) return false;
        units.push_back(g / length);
        direction += units.back();
      }
      all.push_back(std::move(one));
      of.push_back(cell.active[i]);
    }
    for (int turn = 0; turn < kTurns; ++turn) {
      const double length = direction.norm();
      if (!(length > 1e-9)) return false;
      direction /= length;
      double least = std::numeric_limits<double>::infinity();
      Vec3 worst = Vec3::Zero();
      for (const Vec3& u : units)
        if (const double height = direction.dot(u); height < least) {
          least = height;
          worst = u;
        }
      if (least > 0) {
        bool rises = true;
        for (std::size_t i = 0; i < all.size() && rises; ++i)
          rises = leads_away(direction, of[i], all[i]);
        if (rises) return true;
      }
      direction += 0.7 * worst;
    }
    return false;
  }

  std::vector<Body> bodies_;
};

}  // namespace

Inclusion verify_body_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                            const InclusionOptions& options) {
  return union_cover::decide(original, set, Bodies(set), options);
}

}  // namespace kaboum::verify
