// Parts of boxes, cut along the prisms over the triangles that distances are measured to.
// docs/algorithms/exact-inclusion.md, "Uncovered regions".
#include "prism_cuts.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace kaboum::verify {
namespace {

constexpr std::size_t kMaxPrisms = 100;

/// The lowest and the highest corner over a plane.
std::pair<double, double> range(const Part& part, const Plane& plane) {
  std::pair<double, double> out{std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
  for (const Vec3& x : part.corners) {
    const double h = plane.normal.dot(x) - plane.height;
    out = {std::min(out.first, h), std::max(out.second, h)};
  }
  return out;
}

/// Whether the part is within the limit of one triangle, or its cuts along the sides of the prism
/// over the nearest one are. @param prisms  that were cut along, in all; @param work  so far
bool near_after_cuts(const RegionSearch& search, const Part& part, std::uint32_t face,
                     std::size_t& prisms, std::size_t& work) {
  const NearestTriangle target(search.limit.triangles, search.limit.target);
  std::vector<Part> open{part}, pieces, next;
  while (!open.empty()) {
    const Part piece = open.back();
    open.pop_back();
    ++work;
    const std::vector<Vec3> points(piece.corners.begin(), piece.corners.end());
    if (search.near(points, face)) continue;
    const Vec3 middle = 0.25 * (points[0] + points[1] + points[2] + points[3]);
    const NearestTriangle::Hit hit = target.nearest(middle, face);
    const std::uint32_t f = hit.face;
    if (f == NearestTriangle::kNone || hit.distance > search.limit.distance) return false;
    double radius = 0;
    for (const Vec3& x : points) radius = std::max(radius, (x - middle).norm());
    if (hit.distance + radius + 2 * search.slack <= search.limit.distance || search.near(points, f))
      continue;
    if (++prisms > kMaxPrisms || piece.cuts > kMostCuts - 4) return false;
    pieces.assign(1, piece);
    const Vec3& a = search.limit.triangles.corner(f, 0);
    const Vec3 normal =
        (search.limit.triangles.corner(f, 1) - a).cross(search.limit.triangles.corner(f, 2) - a);
    for (int k = 0; k < 3; ++k) {
      const Vec3 across =
          (search.limit.triangles.corner(f, (k + 1) % 3) - search.limit.triangles.corner(f, k))
              .cross(normal);
      const double length = across.norm();
      if (!(length > 0)) return false;
      const Plane side{across / length, across.dot(search.limit.triangles.corner(f, k)) / length};
      next.clear();
      for (const Part& x : pieces) {
        const auto [low, high] = range(x, side);
        if (low >= -4 * search.slack || high <= 4 * search.slack) {
          next.push_back(x);
        } else {
          cut(x, side, next, next);
        }
      }
      pieces.swap(next);
    }
    if (pieces.size() == 1) return false;
    open.insert(open.end(), pieces.begin(), pieces.end());
  }
  return true;
}

}  // namespace

bool near_after_cuts(const RegionSearch& search, const std::vector<Part>& parts, std::uint32_t face,
                     std::size_t& work) {
  double most = -1;
  Vec3 farthest = Vec3::Zero();
  for (const Part& part : parts) {
    for (const Vec3& x : part.corners) {
      const double square = (x - search.closest(x, face)).squaredNorm();
      if (square <= most) continue;
      most = square;
      farthest = x;
    }
  }
  const NearestTriangle target(search.limit.triangles, search.limit.target);
  if (most > search.limit.distance * search.limit.distance &&
      target.nearest(farthest, face).distance > search.limit.distance)
    return false;
  std::size_t prisms = 0;
  return std::all_of(parts.begin(), parts.end(), [&](const Part& part) {
    return near_after_cuts(search, part, face, prisms, work);
  });
}

}  // namespace kaboum::verify
