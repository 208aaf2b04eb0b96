// After Deits and Tedrake, "Computing large convex regions of obstacle-free
// space through semidefinite programming" (2015): separating planes in the
// order of distance, then an ellipsoid, in turn. The ellipsoid here is that of
// the body's covariance, which needs no optimisation.
#include "inscribe.h"

#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/point_triangle.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kaboum::bcd {
namespace {

using geom::Triangle;

// Lengths and shares that steer the growing of a body. That it lies inside is decided exactly on
// what is written; only kMarginSpacings serves that.

/// Planes keep this many float32 spacings from triangles (times `safety`): each coordinate of a
/// corner is rounded by half a spacing, a plane's height by less than √3 of that, and cuts by less.
constexpr double kMarginSpacings = 2;
/// Bodies whose seed is not deeper than so many margins are not worth it.
constexpr double kLeastMargins = 4;
/// Shortest axis of an ellipsoid, as a share of the variance of the longest.
constexpr double kFlattest = 1e-4;
/// A triangle's corner may be this share of the box's diagonal below a plane that keeps it out.
constexpr double kTouch = 1e-9;
/// Twice the area of triangles that have no plane, in squares of kTouch.
constexpr double kNoArea = 1e-12;
/// Triangles whose own planes are tried, of those as near as the nearest but for a share.
constexpr std::size_t kNearest = 8;
constexpr double kAsNear = 1e-6;
/// What a triangle's own plane leaves of the seed's depth at least, and by what share it has to
/// leave more than the plane that touches the ellipsoid.
constexpr double kKeptDepth = 0.5, kMoreVolume = 1e-9;
/// Searching goes on elsewhere once a body holds the seed and what is within this share of its
/// depth.
constexpr double kCore = 0.25;
/// What is kept of the ball round the seed where vertices are left out, as a share of its depth.
constexpr double kSeedDepth = 0.8;
/// Another ellipsoid is tried while bodies grow by this factor.
constexpr double kBetter = 1.01;

double volume_of(const Cell& cell) {
  double volume = 0;
  const Vec3 center = cell.center();
  for (std::size_t f = 0; f < cell.faces.size(); ++f) {
    const std::span<const std::uint32_t> face = cell.faces[f];
    const Vec3 a = cell.corners[face[0]] - center;
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      volume += a.dot((cell.corners[face[k]] - center).cross(cell.corners[face[k + 1]] - center));
  }
  return std::abs(volume) / 6;
}

struct Ellipsoid {
  Vec3 center;
  Eigen::Matrix3d to_ball;  ///< p ↦ to_ball (p − center)
};

/// Center of mass and covariance of a hull, scaled to unit determinant.
std::optional<Ellipsoid> ellipsoid_of(const Mesh& hull) {
  const Vec3 origin = geom::bounding_box(hull).center();
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Triangle& t : hull.triangles) {
    const Vec3 a = hull.vertices[t[0]] - origin, b = hull.vertices[t[1]] - origin,
               c = hull.vertices[t[2]] - origin;
    const double v = a.dot(b.cross(c)) / 6;
    const Vec3 sum = a + b + c;
    volume += v;
    first += v / 4 * sum;
    second += v / 20 *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  if (!(volume > 0)) return std::nullopt;
  const Vec3 mean = first / volume;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(
      Eigen::Matrix3d(second / volume - mean * mean.transpose()));
  const Vec3 variance = eigen.eigenvalues().cwiseMax(kFlattest * eigen.eigenvalues().maxCoeff());
  if (!(variance.minCoeff() > 0) || !eigen.eigenvectors().allFinite()) return std::nullopt;
  const double scale = std::pow(variance.prod(), 1.0 / 6);
  Ellipsoid out;
  out.center = origin + mean;
  out.to_ball = eigen.eigenvectors() * (scale * variance.cwiseSqrt().cwiseInverse()).asDiagonal() *
                eigen.eigenvectors().transpose();
  return out;
}

/// The cell that planes leave which keep the triangles out, nearest first.
std::optional<Cell> keep_out(const Mesh& boundary, const Box3& box, const Ellipsoid& e,
                             const Vec3& seed, double depth, double margin) {
  struct Obstacle {
    double distance;
    std::uint32_t triangle;
    Vec3 at;  // nearest point, in the ball's space
  };
  const Eigen::Matrix3d back = e.to_ball.inverse();
  std::vector<Vec3> moved;
  moved.reserve(boundary.vertices.size());
  for (const Vec3& p : boundary.vertices) moved.emplace_back(e.to_ball * (p - e.center));
  std::vector<Obstacle> rest;
  rest.reserve(boundary.triangles.size());
  for (std::uint32_t i = 0; i < boundary.triangles.size(); ++i) {
    const Triangle& t = boundary.triangles[i];
    const Vec3 at = geom::nearest_point(Vec3::Zero(), moved[t[0]], moved[t[1]], moved[t[2]]);
    rest.push_back({at.norm(), i, at});
  }
  std::sort(rest.begin(), rest.end(), [](const Obstacle& a, const Obstacle& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
  Cell cell = Cell::of(box);
  const double touch = kTouch * box.diagonal();
  const auto beyond = [&](const Plane& plane, std::uint32_t i) {
    for (const std::uint32_t v : boundary.triangles[i])
      if (plane.height(boundary.vertices[v]) < -touch) return false;
    return true;
  };
  const auto plane_of = [&](std::uint32_t i, Plane& plane) {
    const Triangle& t = boundary.triangles[i];
    const Vec3& a = boundary.vertices[t[0]];
    const Vec3 n = (boundary.vertices[t[1]] - a).cross(boundary.vertices[t[2]] - a);
    const double length = n.norm();
    if (!(length > kNoArea * touch * touch)) return false;
    plane = {n / length, n.dot(a) / length};
    if (plane.height(seed) > 0) plane = {-plane.n, -plane.d};
    return true;
  };
  while (!rest.empty()) {
    const Obstacle nearest = rest.front();
    double farthest = 0;
    for (const Vec3& p : cell.corners)
      farthest = std::max(farthest, (e.to_ball * (p - e.center)).norm());
    if (nearest.distance > farthest) break;
    if (!(nearest.distance > 0)) return std::nullopt;
    // The plane that touches the ellipsoid, or a triangle's own: whichever
    // leaves more.
    Plane best;
    best.n = (e.to_ball.transpose() * nearest.at).normalized();
    best.d = best.n.dot(back * nearest.at + e.center);
    Cell left = clip(cell, {best.n, best.d - margin}, true, 0);
    double volume = left.corners.empty() ? 0 : volume_of(left);
    for (std::size_t k = 0; k < rest.size() && k < kNearest; ++k) {
      if (rest[k].distance > nearest.distance * (1 + kAsNear)) break;
      Plane plane;
      if (!plane_of(rest[k].triangle, plane)) continue;
      if (plane.height(seed) > -kKeptDepth * depth || plane.height(e.center) > -margin ||
          !beyond(plane, nearest.triangle))
        continue;
      Cell other = clip(cell, {plane.n, plane.d - margin}, true, 0);
      const double v = other.corners.empty() ? 0 : volume_of(other);
      if (v <= volume * (1 + kMoreVolume)) continue;
      volume = v;
      best = plane;
      left = std::move(other);
    }
    if (!(volume > 0) || best.height(seed) > -margin) return std::nullopt;
    cell = std::move(left);
    std::erase_if(rest, [&](const Obstacle& o) {
      return o.triangle == nearest.triangle || beyond(best, o.triangle);
    });
  }
  return cell;
}

/// The hull of `most` of the points: the extreme ones, then always the one
/// farthest beyond the facet nearest to the seed, until the ball round it is
/// inside; then the one farthest outside.
std::vector<Vec3> subset(std::vector<Vec3> points, std::size_t most, const Vec3& seed,
                         double ball) {
  if (points.size() <= most) return points;
  std::vector<Vec3> out;
  std::vector<char> taken(points.size(), 0);
  const auto take = [&](std::size_t i) {
    if (taken[i] == 0) out.push_back(points[i]);
    taken[i] = 1;
  };
  for (int k = 0; k < 3; ++k) {
    std::size_t low = 0, high = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i][k] < points[low][k]) low = i;
      if (points[i][k] > points[high][k]) high = i;
    }
    take(low);
    take(high);
  }
  geom::HullBuilder builder;
  while (out.size() < most) {
    std::size_t best = points.size();
    double farthest = 0;
    if (!builder.build(out)) {
      // Still flat: any point more.
      for (std::size_t i = 0; i < points.size() && best == points.size(); ++i)
        if (taken[i] == 0) best = i;
    } else {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Triangle& t : builder.triangles()) {
        const Vec3 n = (out[t[1]] - out[t[0]]).cross(out[t[2]] - out[t[0]]);
        const double length = n.norm();
        if (!(length > 0)) continue;
        std::size_t beyond = points.size();
        double height = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
          const double h = n.dot(points[i] - out[t[0]]) / length;
          if (taken[i] != 0 || h <= height) continue;
          height = h;
          beyond = i;
        }
        if (beyond == points.size()) continue;
        const double from_seed = std::min(n.dot(out[t[0]] - seed) / length, ball);
        if (from_seed > nearest || (from_seed == nearest && height <= farthest)) continue;
        nearest = from_seed;
        farthest = height;
        best = beyond;
      }
    }
    if (best == points.size()) break;
    take(best);
  }
  return out;
}

/// Corners of a large box that contains the seed and lies in the body, its axes
/// those of the body's covariance: faces move outwards in turn, half as far as
/// they can and at last all the way.
std::vector<Vec3> box_within(const Inscribed& body, const Ellipsoid& e, const Vec3& seed) {
  constexpr int kRounds = 12;
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(e.to_ball).eigenvectors();
  std::array<Vec3, 2> extent{Vec3::Zero(), Vec3::Zero()};  // from the seed, along −axes and axes
  const auto room = [&](int side, int k) {
    double least = std::numeric_limits<double>::infinity();
    for (const Plane& plane : body.planes) {
      const Vec3 slope = axes.transpose() * plane.n;
      const double along = side == 0 ? -slope[k] : slope[k];
      if (along <= 0) continue;
      double height = plane.height(seed);
      for (int i = 0; i < 3; ++i)
        height += slope[i] > 0 ? slope[i] * extent[1][i] : -slope[i] * extent[0][i];
      least = std::min(least, -height / along);
    }
    return std::max(0.0, least);
  };
  for (int round = 1; round <= kRounds; ++round)
    for (int k = 0; k < 3; ++k)
      for (const int side : {0, 1})
        extent[side][k] += (round < kRounds ? 0.5 : 1.0) * room(side, k);
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    Vec3 p = seed;
    for (int k = 0; k < 3; ++k)
      p += ((i >> k & 1) != 0 ? extent[1][k] : -extent[0][k]) * axes.col(k);
    corners.push_back(p);
  }
  return corners;
}

/// The hull of the points, rounded to float32.
std::optional<Inscribed> hull_of(std::vector<Vec3> points) {
  for (Vec3& p : points) p = geom::to_float32(p);
  geom::HullBuilder builder;
  if (!builder.build(points)) return std::nullopt;
  Inscribed out;
  out.hull = builder.mesh();
  out.box = geom::bounding_box(out.hull);
  out.volume = geom::signed_volume(out.hull);
  for (const Triangle& t : out.hull.triangles) {
    const Vec3& a = out.hull.vertices[t[0]];
    const Vec3 n = (out.hull.vertices[t[1]] - a).cross(out.hull.vertices[t[2]] - a);
    const double length = n.norm();
    if (length > 0) out.planes.push_back({n / length, n.dot(a) / length});
  }
  return out;
}

/// A body round the seed with at most `most` of the hull's vertices, or a box
/// in it if that is larger.
std::optional<Inscribed> body_of(std::vector<Vec3> points, std::size_t most, const Vec3& seed,
                                 double ball, double core) {
  std::optional<Inscribed> whole = hull_of(std::move(points));
  if (!whole || whole->hull.vertices.size() <= most) return whole;
  std::optional<Inscribed> out = hull_of(subset(whole->hull.vertices, most, seed, ball));
  if (out && !out->contains(seed, core)) out.reset();
  if (const std::optional<Ellipsoid> e = ellipsoid_of(whole->hull)) {
    std::optional<Inscribed> box = hull_of(box_within(*whole, *e, seed));
    if (box && box->contains(seed, core) && (!out || box->volume > out->volume))
      out = std::move(box);
  }
  return out;
}

}  // namespace

bool Inscribed::contains(const Vec3& p, double slack) const {
  for (const Plane& plane : planes)
    if (plane.height(p) > -slack) return false;
  return true;
}

std::optional<Inscribed> inscribe(const Mesh& boundary, const Vec3& seed, double depth,
                                  std::size_t most, int rounds, double safety) {
  Box3 box = geom::bounding_box(boundary);
  const double ulp =
      geom::float32_spacing(std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()));
  const double margin = kMarginSpacings * ulp * safety;
  if (!(depth > kLeastMargins * margin)) return std::nullopt;
  const double core = std::max(margin, kCore * depth);
  std::optional<Inscribed> best;
  Ellipsoid e{seed, Eigen::Matrix3d::Identity()};
  for (int round = 0; round <= rounds; ++round) {
    const std::optional<Cell> cell = keep_out(boundary, box, e, seed, depth, margin);
    if (!cell) break;
    std::optional<Inscribed> body = body_of(cell->corners, most, seed, kSeedDepth * depth, core);
    if (!body || !body->contains(seed, core)) break;
    const bool better = !best || body->volume > kBetter * best->volume;
    if (better) best = std::move(body);
    if (!better) break;
    const std::optional<Ellipsoid> next = ellipsoid_of(best->hull);
    if (!next) break;
    e = *next;
  }
  if (!best) {
    std::vector<Vec3> cube;
    cube.reserve(8);
    const double half = (depth - margin) / kHalfDiagonal;
    for (int i = 0; i < 8; ++i)
      cube.emplace_back(
          seed + half * Vec3((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1));
    best = hull_of(std::move(cube));
  }
  return best;
}

}  // namespace kaboum::bcd
