// Balls round and in convex bodies. Cutting is convex: a part below a plane is the hull of the
// corners below it and of the points where edges cross the plane. docs/algorithms/batches.md.

#include "ball_cover.h"

#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/convex_polytope.h>
#include <kaboum/geom/point_triangle.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace kaboum::filter::detail {
namespace {

/// What rounded cuts leave out between two parts, of the largest coordinate.
constexpr double kCuts = 0x1p-38;

/// A part of a body's core: the hull of points.
struct Part {
  std::size_t set = 0, body = 0;
  std::vector<Vec3> points;
  Vec3 axis = Vec3::UnitX();  ///< along which it is longest
  Vec3 middle = Vec3::Zero();
  Ball ball;          ///< round the points
  double excess = 0;  ///< how far the ball reaches beyond the part, about

  friend bool operator<(const Part& a, const Part& b) { return a.excess < b.excess; }
};

double magnitude_of(const std::vector<Vec3>& points) {
  double most = 0;
  for (const Vec3& p : points) most = std::max(most, p.cwiseAbs().maxCoeff());
  return most;
}

void measure(Part& part) {
  part.ball = ball_round(part.points);
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : part.points) mean += p / static_cast<double>(part.points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Vec3& p : part.points) moments += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
  double longest = -1, shortest = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = solver.eigenvectors().col(k);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Vec3& p : part.points) {
      low = std::min(low, axis.dot(p));
      high = std::max(high, axis.dot(p));
    }
    shortest = std::min(shortest, high - low);
    if (high - low <= longest) continue;
    longest = high - low;
    part.axis = axis;
    part.middle = mean + axis * (0.5 * (low + high) - axis.dot(mean));
  }
  part.excess = part.ball.radius - 0.5 * shortest;
}

/// Pairs of points whose segments hold all edges of the hull.
template <typename Visit>
void visit_edges(const std::vector<Vec3>& points, const Visit& visit) {
  geom::HullBuilder hull;
  if (hull.build(points)) {
    for (const geom::Triangle& t : hull.triangles())
      for (std::size_t k = 0; k < 3; ++k)
        if (t[k] < t[(k + 1) % 3]) visit(points[t[k]], points[t[(k + 1) % 3]]);
    return;
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) visit(points[i], points[j]);
}

/// The points that the hull needs.
std::vector<Vec3> hull_of(const std::vector<Vec3>& points) {
  geom::HullBuilder hull;
  if (!hull.build(points)) return points;
  std::vector<Vec3> out;
  for (const std::uint32_t v : hull.vertices()) out.push_back(points[v]);
  return out;
}

/// The part on one side of the plane in its middle.
Part half_of(const Part& part, double side) {
  Part out;
  out.set = part.set;
  out.body = part.body;
  const auto above = [&](const Vec3& p) { return side * part.axis.dot(p - part.middle); };
  for (const Vec3& p : part.points)
    if (above(p) >= 0) out.points.push_back(p);
  visit_edges(part.points, [&](const Vec3& p, const Vec3& q) {
    const double a = above(p), b = above(q);
    if ((a < 0) != (b < 0)) out.points.emplace_back(p + a / (a - b) * (q - p));
  });
  out.points = hull_of(out.points);
  return out;
}

}  // namespace

// Bădoiu and Clarkson, 2003.
Ball ball_round(const std::vector<Vec3>& points) {
  Vec3 center = Vec3::Zero();
  for (const Vec3& p : points) center += p / static_cast<double>(points.size());
  const auto farthest = [&] {
    return *std::ranges::max_element(points, {},
                                     [&](const Vec3& p) { return (p - center).squaredNorm(); });
  };
  for (int i = 1; i <= 200; ++i) center += (farthest() - center) / (i + 1);
  return {center, (farthest() - center).norm() * (1 + 0x1p-40) + kCuts * magnitude_of(points)};
}

Ball inner_ball(const geom::ConvexBody& body, const Vec3& near) {
  const geom::Mesh& core = body.core;
  if (core.triangles.empty()) {
    const Vec3& a = core.vertices.front();
    const Vec3 along = core.vertices.back() - a;
    const double length = along.squaredNorm();
    const double share = length > 0 ? std::clamp(along.dot(near - a) / length, 0.0, 1.0) : 0.0;
    return {a + share * along, body.radius - kCuts * magnitude_of(core.vertices)};
  }
  const geom::ConvexPolytope polytope(core);
  const auto depth = [&](const Vec3& p) {
    if (!polytope.contains(p)) return -1.0;
    double least = HUGE_VAL;
    for (const geom::Triangle& t : core.triangles)
      least = std::min(least, geom::point_triangle_distance(
                                  p, core.vertices[t[0]], core.vertices[t[1]], core.vertices[t[2]])
                                  .lower);
    return least + body.radius * (1 - 0x1p-40);
  };
  Ball best{near, depth(near)};
  double step = 0.5 * (core.vertices.front() - near).norm();
  for (int round = 0; round < 6; ++round, step *= 0.5)
    for (int k = 0; k < 6; ++k) {
      const Vec3 p = best.center + (k < 3 ? step : -step) * Vec3::Unit(k % 3);
      if (const double here = depth(p); here > best.radius) best = {p, here};
    }
  return best;
}

std::vector<BallCover> cover_by_balls(const std::vector<const collide::BoundingSet*>& sets,
                                      std::size_t most) {
  constexpr double kFineEnough = 0.002;  // of the set's radius
  std::priority_queue<Part> parts;
  std::vector<Part> done;
  for (std::size_t s = 0; s < sets.size(); ++s)
    for (std::size_t b = 0; b < sets[s]->size(); ++b) {
      Part part;
      part.set = s;
      part.body = b;
      part.points = sets[s]->body(b).core.vertices;
      measure(part);
      parts.push(std::move(part));
    }
  while (!parts.empty() && parts.size() + done.size() < most) {
    Part part = parts.top();
    parts.pop();
    if (part.points.size() < 2 || part.excess <= kFineEnough * sets[part.set]->ball().radius) {
      done.push_back(std::move(part));
      continue;
    }
    for (const double side : {1.0, -1.0}) {
      Part half = half_of(part, side);
      if (half.points.empty()) continue;
      measure(half);
      parts.push(std::move(half));
    }
  }
  for (; !parts.empty(); parts.pop()) done.push_back(parts.top());
  // Of each body, the large ones first.
  std::ranges::stable_sort(done, [](const Part& a, const Part& b) {
    if (a.set != b.set) return a.set < b.set;
    if (a.body != b.body) return a.body < b.body;
    return a.ball.radius > b.ball.radius;
  });
  std::vector<BallCover> out(sets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) out[s].bodies.assign(sets[s]->size() + 1, 0);
  for (const Part& part : done) {
    BallCover& cover = out[part.set];
    const geom::ConvexBody& body = sets[part.set]->body(part.body);
    cover.outer.push_back({part.ball.center, (part.ball.radius + body.radius) * (1 + 0x1p-40)});
    ++cover.bodies[part.body + 1];
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : part.points) mean += p / static_cast<double>(part.points.size());
    if (const Ball inner = inner_ball(body, mean); inner.radius > 0) cover.inner.push_back(inner);
  }
  for (BallCover& cover : out) {
    std::partial_sum(cover.bodies.begin(), cover.bodies.end(), cover.bodies.begin());
    std::ranges::stable_sort(cover.inner, std::ranges::greater{}, &Ball::radius);
  }
  return out;
}

}  // namespace kaboum::filter::detail
