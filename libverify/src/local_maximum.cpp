// Where no point of a ball can be a local maximum of the distance.
// docs/algorithms/exact-inclusion.md, "Uncovered regions".
#include "local_maximum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kaboum::verify {
namespace {

constexpr std::size_t kFewFaces = 1000;
constexpr int kMaxTilts = 8;

/// A lower bound of u·(y − p) over the points y of a face within `range` of p: the least at its
/// corners or, with y − p = αn + s, s ⊥ n, α ≥ h ≥ 0 for any unit vector n, that of αu·n + u·s,
/// |s|² ≤ range² − α², which is least at α = h if u·n ≥ 0.
double height_within(const RegionSearch& search, const Vec3& p, double range, const Vec3& u,
                     std::uint32_t f) {
  const std::array<Vec3, 3> v{search.limit.triangles.corner(f, 0) - p,
                              search.limit.triangles.corner(f, 1) - p,
                              search.limit.triangles.corner(f, 2) - p};
  const double corners = std::min({u.dot(v[0]), u.dot(v[1]), u.dot(v[2])});
  Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]);
  if (!(n.norm() > 0)) return corners;
  n.normalize();
  if (n.dot(v[0]) < 0) n = -n;
  const double h = std::min({n.dot(v[0]), n.dot(v[1]), n.dot(v[2])}) - search.slack;
  const double along = u.dot(n);
  if (!(h >= 0 && along >= 0 && h <= range)) return corners;
  const double across = (u - along * n).norm() + 0x1p-48;
  return std::max(corners, h * along - std::sqrt(range * range - h * h) * across * (1 + 0x1p-48) -
                               search.slack);
}

}  // namespace

bool no_maximum(const RegionSearch& search, const Vec3& p, double radius, double distance) {
  if (distance <= radius) return false;
  const double range = (distance + 2 * radius + 2 * search.slack) * (1 + 0x1p-40);
  std::vector<std::uint32_t> faces;
  bool few = true;
  search.limit.all.query(
      [&](const Bounds& box) {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
          const double d = std::max({box.low[k] - p[k], p[k] - box.high[k], 0.0});
          square += d * d;
        }
        return few && square <= range * range;
      },
      [&](std::uint32_t f) {
        few = few && faces.size() < kFewFaces;
        faces.push_back(f);
      });
  if (!few || faces.empty()) return false;
  Vec3 towards = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t f : faces) {
    const Vec3 to = search.closest(p, f) - p;
    if (!(to.norm() < least)) continue;
    least = to.norm();
    towards = to;
  }
  // The face that is beyond the plane least pulls it to its side.
  for (int i = 0; i < kMaxTilts && towards.norm() > 0; ++i) {
    const Vec3 u = towards.normalized();
    double lowest = std::numeric_limits<double>::infinity();
    std::uint32_t worst = faces.front();
    for (const std::uint32_t f : faces) {
      const double height = height_within(search, p, range, u, f);
      if (!(height < lowest)) continue;
      lowest = height;
      worst = f;
    }
    if (lowest > radius + search.slack) return true;
    towards = u + (search.closest(p, worst) - p).normalized();
  }
  return false;
}

}  // namespace kaboum::verify
