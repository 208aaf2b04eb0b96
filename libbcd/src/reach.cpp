#include "reach.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cell.h"
#include "nearly_within.h"

namespace kaboum::bcd {
namespace {

class Measure {
 public:
  Measure(const Mesh& body, const Solid& solid, const ReachOptions& options)
      : body_(body), solid_(solid), options_(options) {
    // Rounding of midpoints, far above what is possible.
    slack_ = 1e-13 * (solid.box().min.cwiseAbs().cwiseMax(solid.box().max.cwiseAbs()).maxCoeff() +
                      solid.diagonal());
  }

  /// A first lower bound, from the facets' centres.
  double sample() {
    for (const Triangle& t : body_.triangles) {
      const Vec3 c = (body_.vertices[t[0]] + body_.vertices[t[1]] + body_.vertices[t[2]]) / 3;
      if (solid_.field(c) > result_.lower - 2 * solid_.spacing() && !solid_.contains(c))
        raise(solid_.surface().nearest(c).lower, c);
    }
    return result_.lower;
  }

  Reach run(double floor) {
    floor_ = floor;
    if (floor > 0 && nearly_within(body_, solid_, floor, slack_)) {
      settle(floor);
    } else {
      facets();
      inside();
    }
    result_.upper = std::max({result_.lower, settled_, 0.0});
    if (result_.upper > 0) result_.upper += slack_;
    return result_;
  }

 private:
  struct Piece {
    std::array<Vec3, 3> corner;
    std::uint32_t hint;
  };
  struct Cube {
    Vec3 center;
    double half;
    std::uint32_t hint;
  };

  [[nodiscard]] double limit() const {
    return std::max({floor_, result_.lower * (1 + options_.relative_gap),
                     result_.lower + options_.absolute_gap});
  }
  void settle(double upper) { settled_ = std::max(settled_, upper); }
  void raise(double lower, const Vec3& at) {
    if (lower <= result_.lower) return;
    result_.lower = lower;
    result_.at = at;
  }

  void facets() {
    std::vector<Piece> stack;
    for (const Triangle& t : body_.triangles)
      stack.push_back({{body_.vertices[t[0]], body_.vertices[t[1]], body_.vertices[t[2]]},
                       geom::DistanceQuery::kNone});
    std::size_t work = 0;
    while (!stack.empty()) {
      Piece p = stack.back();
      stack.pop_back();
      const auto& [a, b, c] = p.corner;
      const Vec3 center = (a + b + c) / 3;
      const double radius = std::sqrt(std::max(
          {(a - center).squaredNorm(), (b - center).squaredNorm(), (c - center).squaredNorm()}));
      const auto at = solid_.surface().nearest(center, p.hint);
      double upper = at.upper + radius;
      if (upper > limit()) {
        double corners = 0;
        for (const Vec3& v : p.corner)
          corners = std::max(corners, solid_.surface().to_triangle(v, at.triangle).upper);
        upper = std::min(upper, corners);
      }
      if (upper > limit()) {
        if (solid_.contains(center)) {
          if (at.lower >= radius * (1 + 1e-12)) continue;
          upper = std::min(upper, radius);
        } else {
          raise(at.lower, center);
        }
      }
      if (upper <= limit() || ++work > options_.most) {
        settle(upper);
        continue;
      }
      int k = 0;
      double longest = -1;
      for (int i = 0; i < 3; ++i) {
        const double l = (p.corner[(i + 1) % 3] - p.corner[i]).squaredNorm();
        if (l > longest) {
          longest = l;
          k = i;
        }
      }
      const Vec3 middle = 0.5 * p.corner[k] + 0.5 * p.corner[(k + 1) % 3];
      Piece q = p;
      p.corner[(k + 1) % 3] = middle;
      q.corner[k] = middle;
      p.hint = q.hint = at.triangle;
      stack.push_back(p);
      stack.push_back(q);
    }
  }

  void inside() {
    Box3 box;
    for (const Vec3& p : body_.vertices) box.extend(p);
    std::vector<Plane> planes, crossing;
    for (const Triangle& t : body_.triangles) {
      const Vec3& a = body_.vertices[t[0]];
      const Vec3 n = (body_.vertices[t[1]] - a).cross(body_.vertices[t[2]] - a);
      const double length = n.norm();
      if (length > 0) planes.push_back({n / length, n.dot(a) / length});
    }
    std::vector<Cube> stack;
    for (const bcd::Cube& cube : cubes_over(box))
      stack.push_back({cube.center, cube.half, geom::DistanceQuery::kNone});
    std::size_t work = 0;
    while (!stack.empty()) {
      const Cube cube = stack.back();
      stack.pop_back();
      bool outside = false, within = true;
      crossing.clear();
      for (const Plane& plane : planes) {
        const double h = plane.height(cube.center), extent = cube.half * plane.n.cwiseAbs().sum();
        if (h - extent > slack_) {
          outside = true;
          break;
        }
        within = within && h <= -slack_;
        if (h + extent > -slack_) crossing.push_back(plane);
      }
      if (outside) continue;
      const double radius = cube.half * 1.7320508075688774;
      const auto at = solid_.surface().nearest(cube.center, cube.hint);
      double upper = at.upper + radius;
      if (upper > limit()) {
        if (solid_.contains(cube.center)) {
          if (at.lower >= radius * (1 + 1e-12)) continue;
          upper = std::min(upper, radius);
        } else if (within) {
          raise(at.lower, cube.center);
        }
      }
      if (upper > limit() && crossing.size() <= 12) {
        // The distance to one triangle is convex: largest at a corner of the cube's part in the
        // body.
        const Vec3 h = Vec3::Constant(cube.half);
        Cell part = Cell::of({cube.center - h, cube.center + h});
        for (const Plane& plane : crossing) part = clip(part, plane, true, slack_);
        double corners = 0;
        for (const Vec3& v : part.corners)
          corners = std::max(corners, solid_.surface().to_triangle(v, at.triangle).upper);
        upper = std::min(upper, corners);
      }
      if (upper <= limit() || ++work > options_.most) {
        settle(upper);
        continue;
      }
      const double h = 0.5 * cube.half;
      for (int i = 0; i < 8; ++i)
        stack.push_back({cube.center + Vec3((i & 1) != 0 ? h : -h, (i & 2) != 0 ? h : -h,
                                            (i & 4) != 0 ? h : -h),
                         h, at.triangle});
    }
  }

  const Mesh& body_;
  const Solid& solid_;
  const ReachOptions& options_;
  double floor_ = 0;
  double slack_ = 0;
  double settled_ = 0;
  Reach result_;
};

}  // namespace

std::vector<Reach> measure(const std::vector<Mesh>& bodies, const Solid& solid,
                           const ReachOptions& options, double floor, double ceiling) {
  std::vector<Measure> measures;
  measures.reserve(bodies.size());
  for (const Mesh& body : bodies) measures.emplace_back(body, solid, options);
  std::vector<double> sampled(bodies.size());
  tbb::parallel_for(std::size_t{0}, bodies.size(),
                    [&](std::size_t i) { sampled[i] = measures[i].sample(); });
  // Only the largest matters: the others are told from it, not measured.
  for (const double s : sampled) floor = std::max(floor, std::min(0.7 * s, ceiling));
  std::vector<Reach> out(bodies.size());
  tbb::parallel_for(std::size_t{0}, bodies.size(),
                    [&](std::size_t i) { out[i] = measures[i].run(floor); });
  return out;
}

}  // namespace kaboum::bcd
