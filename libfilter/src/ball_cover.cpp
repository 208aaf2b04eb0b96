// Balls round and in convex bodies. A part below a plane is the hull of the corners below it and of
// the points where edges cross the plane: faces are cut, and no hull is made.
// docs/algorithms/batches.md.

#include "ball_cover.h"

#include <kaboum/geom/convex_polytope.h>
#include <kaboum/geom/point_triangle.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>

namespace kaboum::filter::detail {
namespace {

/// What rounded cuts leave out between two parts, of the largest coordinate.
constexpr double kCuts = 0x1p-38;

/// A part of a body's core: the hull of points. Its faces have all of its edges; those that cuts
/// have opened are left out.
struct Part {
  std::size_t set = 0, body = 0;
  std::vector<Vec3> points;
  std::vector<std::vector<std::uint32_t>> faces;
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

/// The part on one side of the plane in its middle: each face is cut along it. Edges of what the
/// plane opens are those of faces, too.
Part half_of(const Part& part, double side) {
  constexpr std::uint32_t kNone = ~0U;
  Part out;
  out.set = part.set;
  out.body = part.body;
  std::vector<double> above;
  for (const Vec3& p : part.points) above.push_back(side * part.axis.dot(p - part.middle));
  std::vector<std::uint32_t> kept(part.points.size(), kNone);
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> crossings;
  const auto add = [&](std::uint32_t& number, const Vec3& p) {
    if (number != kNone) return number;
    number = static_cast<std::uint32_t>(out.points.size());
    out.points.push_back(p);
    return number;
  };
  for (const std::vector<std::uint32_t>& face : part.faces) {
    std::vector<std::uint32_t> left;
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t p = face[k], q = face[(k + 1) % face.size()];
      if (above[p] >= 0) left.push_back(add(kept[p], part.points[p]));
      if ((above[p] < 0) == (above[q] < 0)) continue;
      const auto [a, b] = std::minmax(p, q);
      std::uint32_t& crossing = crossings.try_emplace({a, b}, kNone).first->second;
      left.push_back(add(crossing, part.points[a] + above[a] / (above[a] - above[b]) *
                                                        (part.points[b] - part.points[a])));
    }
    if (!left.empty()) out.faces.push_back(std::move(left));
  }
  return out;
}

/// The faces of a body's core; of a point or a segment, one that has all points.
std::vector<std::vector<std::uint32_t>> faces_of(const geom::Mesh& core) {
  std::vector<std::vector<std::uint32_t>> out;
  for (const geom::Triangle& t : core.triangles) out.emplace_back(t.begin(), t.end());
  if (!out.empty()) return out;
  out.emplace_back(core.vertices.size());
  std::iota(out.front().begin(), out.front().end(), 0U);
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
      part.faces = faces_of(sets[s]->body(b).core);
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
