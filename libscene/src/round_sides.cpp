// Parts of convex sets that are round about an axis.

#include "round_sides.h"

#include <kaboum/geom/body_polytopes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace kaboum::scene {
namespace {

constexpr std::size_t kSlabs = 64;
/// Share of the radius by which a side may be out of round, beyond ε.
constexpr double kOutOfRound = 0.02;
/// Tangent of the angle by which a side may lean against the axis: 10 degrees.
constexpr double kLeans = 0.17632698070846498;
/// Directions and places of axes that are looked at.
constexpr std::size_t kMostFaces = 6, kMostBodies = 32;

struct Circle {
  Vec2 center = Vec2::Zero();
  double radius = -1;
  [[nodiscard]] bool holds(const Vec2& p) const {
    return (p - center).norm() <= radius * (1 + kNothing);
  }
};

Circle circle_of(const Vec2& a, const Vec2& b) { return {0.5 * (a + b), 0.5 * (a - b).norm()}; }

/// The circle through three points; the smallest round two of them where they are on one line.
Circle circle_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 p = b - a, q = c - a;
  const double twice = 2 * cross(p, q);
  if (std::abs(twice) > kNothing * p.norm() * q.norm()) {
    const Vec2 to = Vec2(q.y() * p.squaredNorm() - p.y() * q.squaredNorm(),
                         p.x() * q.squaredNorm() - q.x() * p.squaredNorm()) /
                    twice;
    return {a + to, to.norm()};
  }
  return std::max({circle_of(a, b), circle_of(b, c), circle_of(a, c)},
                  [](const Circle& x, const Circle& y) { return x.radius < y.radius; });
}

/// The smallest circle round points (Welzl 1991, without recursion).
Circle smallest_circle(const Polygon2& points) {
  Circle out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (out.holds(points[i])) continue;
    out = {points[i], 0};
    for (std::size_t j = 0; j < i; ++j) {
      if (out.holds(points[j])) continue;
      out = circle_of(points[i], points[j]);
      for (std::size_t k = 0; k < j; ++k)
        if (!out.holds(points[k])) out = circle_of(points[i], points[j], points[k]);
    }
  }
  return out;
}

/// By how much less than a circle round it a polygon reaches somewhere.
double out_of_round(const Polygon2& hull, const Circle& circle) {
  double inner = hull.size() < 3 ? 0 : circle.radius;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 edge = hull[(i + 1) % hull.size()] - hull[i];
    if (edge.norm() > 0)
      inner = std::min(inner, cross(hull[i] - circle.center, edge) / edge.norm());
  }
  return circle.radius - inner;
}

/// The bodies of a set as polytopes: those with a radius as polytopes round them.
std::vector<geom::Mesh> polytopes_of(const collide::BoundingSet& set) {
  static const geom::SpherePoints sphere = geom::sphere_points(3);
  std::vector<geom::Mesh> out;
  out.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    out.push_back(set.body(i).radius > 0 ? geom::circumscribed_polytope(set.body(i), sphere)
                                         : set.body(i).core);
  return out;
}

/// A set cut into slabs across an axis.
class Slabs {
 public:
  Slabs(const std::vector<geom::Mesh>& bodies, const Vec3& point, const Vec3& axis)
      : point_(point), axis_(axis), across_(axis) {
    low_ = std::numeric_limits<double>::infinity();
    high_ = -low_;
    for (const geom::Mesh& body : bodies)
      for (const Vec3& v : body.vertices) {
        low_ = std::min(low_, height(v));
        high_ = std::max(high_, height(v));
      }
    points_.resize(kSlabs);
    radii_.assign(kSlabs + 1, 0);
    for (const geom::Mesh& body : bodies) add(body);
  }

  [[nodiscard]] double low(std::size_t slab) const {
    return low_ + (high_ - low_) * static_cast<double>(slab) / kSlabs;
  }

  /// The largest distance from the axis at the height where a slab begins.
  [[nodiscard]] double radius_at(std::size_t slab) const { return radii_[slab]; }

  /// The largest distance of a slab's points from the axis, and by how much less the hull of these
  /// points reaches somewhere.
  struct Round {
    double radius = 0, out_by = 0;
  };
  [[nodiscard]] Round round(std::size_t slab) const {
    const Polygon2 hull = convex_hull(points_[slab]);
    Round out;
    for (const Vec2& p : hull) out.radius = std::max(out.radius, p.norm());
    out.out_by = out_of_round(hull, {Vec2::Zero(), out.radius});
    return out;
  }

 private:
  [[nodiscard]] double height(const Vec3& p) const { return axis_.dot(p - point_); }

  [[nodiscard]] std::size_t slab_at(double height) const {
    const double share = (height - low_) / (high_ - low_) * kSlabs;
    return static_cast<std::size_t>(std::clamp(share, 0.0, static_cast<double>(kSlabs - 1)));
  }

  void put(double at, const Vec2& p) {
    const std::size_t slab = slab_at(at);
    const double nothing = kNothing * (high_ - low_);
    points_[slab].push_back(p);
    // What is between two slabs belongs to both.
    if (at <= low(slab) + nothing) {
      radii_[slab] = std::max(radii_[slab], p.norm());
      if (slab > 0) points_[slab - 1].push_back(p);
    }
    if (at >= low(slab + 1) - nothing) {
      radii_[slab + 1] = std::max(radii_[slab + 1], p.norm());
      if (slab + 1 < kSlabs) points_[slab + 1].push_back(p);
    }
  }

  void add(const geom::Mesh& body) {
    for (const Vec3& v : body.vertices) put(height(v), across_(v - point_));
    for (const geom::Triangle& t : body.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = body.vertices[t[k]], &b = body.vertices[t[(k + 1) % 3]];
        const double at_a = height(a), at_b = height(b);
        if (!(at_a < at_b)) continue;  // the other triangle has it the other way
        for (std::size_t slab = slab_at(at_a); slab <= slab_at(at_b); ++slab) {
          const double at = low(slab);
          if (!(at > at_a && at < at_b)) continue;
          put(at, across_(a + (at - at_a) / (at_b - at_a) * (b - a) - point_));
        }
      }
  }

  Vec3 point_, axis_;
  Axes across_;
  double low_, high_;
  std::vector<Polygon2> points_;
  std::vector<double> radii_;
};

/// The radius of a slab that is round, and the least one at its ends.
struct RoundSlab {
  double radius, least;
};

/// The longest run of slabs that two fingers hold anywhere.
struct Run {
  std::size_t first = 0, count = 0;
  double radius = 0, tolerance = 0;
};
Run longest_run(const std::vector<std::optional<RoundSlab>>& slabs, double thickness,
                double epsilon) {
  Run best;
  for (std::size_t first = 0; first < slabs.size(); ++first) {
    double least = std::numeric_limits<double>::infinity(), largest = 0;
    for (std::size_t i = first; i < slabs.size() && slabs[i]; ++i) {
      const double radius = slabs[i]->radius;
      const double tolerance = epsilon + kOutOfRound * radius;
      bool upright = true;
      for (std::size_t k = first; k < i; ++k)
        upright = upright && std::abs(radius - slabs[k]->radius) <=
                                 tolerance + kLeans * thickness * static_cast<double>(i - k);
      if (!upright) break;
      least = std::min(least, slabs[i]->least);
      largest = std::max(largest, radius);
      const std::size_t count = i + 1 - first;
      if (largest - least > kLeans * thickness * static_cast<double>(count)) continue;
      if (count > best.count)
        best = {first, count, largest, epsilon + kOutOfRound * largest + largest - least};
    }
  }
  return best;
}

/// Directions, each but once, either way.
class Directions {
 public:
  void add(const Vec3& direction) {
    if (std::ranges::none_of(
            all_, [&](const Vec3& other) { return other.cross(direction).norm() <= kParallel; }))
      all_.push_back(direction);
  }
  [[nodiscard]] const std::vector<Vec3>& all() const { return all_; }

 private:
  std::vector<Vec3> all_;
};

std::vector<Vec3> axes_of(const Faces& faces) {
  Directions out;
  for (const Vec3& axis : {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())})
    out.add(axis);
  for (std::size_t i = 0; i < faces.set().size(); ++i) {
    const geom::Mesh& core = faces.set().body(i).core;
    if (core.vertices.size() == 2)
      out.add((core.vertices.back() - core.vertices.front()).normalized());
  }
  std::vector<std::pair<double, const Face*>> largest;
  for (const Face& face : faces.all())
    largest.emplace_back(-centroid_of(flattened(face, Axes(face.normal))).area, &face);
  std::ranges::stable_sort(largest, [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < std::min(largest.size(), kMostFaces); ++i)
    out.add(largest[i].second->normal);
  return out.all();
}

/// Middles of the circles round the projections of a set, and of its bodies that are round.
std::vector<Vec3> points_of_axis(const std::vector<geom::Mesh>& bodies, const Vec3& axis,
                                 double size, double epsilon) {
  const Axes across(axis);
  std::vector<Vec3> out;
  Polygon2 all;
  const auto add = [&](const Circle& circle) {
    const Vec3 point = circle.center.x() * across.u + circle.center.y() * across.v;
    if (std::ranges::none_of(out, [&](const Vec3& other) {
          return (other - point).norm() <= 1e-6 * size + 0.1 * epsilon;
        }))
      out.push_back(point);
  };
  std::vector<Polygon2> projections;
  for (const geom::Mesh& body : bodies) {
    Polygon2 points;
    points.reserve(body.vertices.size());
    for (const Vec3& v : body.vertices) points.push_back(across(v));
    projections.push_back(convex_hull(std::move(points)));
    all.insert(all.end(), projections.back().begin(), projections.back().end());
  }
  add(smallest_circle(convex_hull(std::move(all))));
  for (std::size_t i = 0; i < std::min(projections.size(), kMostBodies); ++i) {
    const Circle circle = smallest_circle(projections[i]);
    if (out_of_round(projections[i], circle) <= epsilon + kOutOfRound * circle.radius) add(circle);
  }
  return out;
}

/// Adds the round sides about one axis.
void add_sides(const std::vector<geom::Mesh>& bodies, const Vec3& point, const Vec3& axis,
               double epsilon, double widest, std::vector<RoundSide>& out) {
  const Slabs slabs(bodies, point, axis);
  const double thickness = slabs.low(1) - slabs.low(0);
  if (!(thickness > 0)) return;
  std::vector<std::optional<RoundSlab>> round_slabs(kSlabs);
  for (std::size_t i = 0; i < kSlabs; ++i) {
    const Slabs::Round round = slabs.round(i);
    if (2 * round.radius <= widest && round.out_by <= epsilon + kOutOfRound * round.radius)
      round_slabs[i] = {round.radius,
                        std::min({round.radius, slabs.radius_at(i), slabs.radius_at(i + 1)})};
  }
  for (;;) {
    const Run run = longest_run(round_slabs, thickness, epsilon);
    if (run.count == 0) return;
    out.push_back({point, axis, slabs.low(run.first), slabs.low(run.first + run.count), run.radius,
                   run.tolerance});
    for (std::size_t i = 0; i < run.count; ++i) round_slabs[run.first + i].reset();
  }
}

bool is_same(const RoundSide& a, const RoundSide& b) {
  const double tolerance = a.tolerance + b.tolerance;
  if (a.axis.cross(b.axis).norm() > kParallel) return false;
  const Vec3 between = b.point - a.point;
  return (between - a.axis.dot(between) * a.axis).norm() <= tolerance &&
         std::min(a.high, b.high) > std::max(a.low, b.low);
}

}  // namespace

std::vector<RoundSide> round_sides_of(const Faces& faces, double widest) {
  const std::vector<geom::Mesh> bodies = polytopes_of(faces.set());
  const double epsilon = faces.set().epsilon();
  std::vector<RoundSide> all;
  for (const Vec3& axis : axes_of(faces))
    for (const Vec3& point : points_of_axis(bodies, axis, faces.size(), epsilon))
      add_sides(bodies, point, axis, epsilon, widest, all);
  std::ranges::stable_sort(all, [](const RoundSide& a, const RoundSide& b) {
    return a.radius * (a.high - a.low) > b.radius * (b.high - b.low) * (1 + kNothing);
  });
  std::vector<RoundSide> out;
  for (const RoundSide& side : all)
    if (std::ranges::none_of(out, [&](const RoundSide& other) { return is_same(side, other); }))
      out.push_back(side);
  return out;
}

}  // namespace kaboum::scene
