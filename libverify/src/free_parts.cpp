// Boxes without their parts that are beyond a surface, and so not in Z.
// docs/algorithms/exact-inclusion.md, "Uncovered regions".
#include "free_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "prism_cuts.h"
#include "tetrahedra.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kMaxFaces = 200, kMaxParts = 300;
constexpr std::size_t kThinWork = 32;  // what trying to cut a box takes, in parts

/// Normals of the nearest face of each kind, both ways.
std::vector<Vec3> directions(const RegionSearch& search, const Vec3& p, std::uint32_t face) {
  std::vector<Vec3> out;
  const std::array<std::uint32_t, 3> faces{
      NearestTriangle(search.meshes, search.boundary).nearest(p).face, face,
      NearestTriangle(search.meshes, kInside).nearest(p).face};
  for (const std::uint32_t f : faces) {
    if (f == NearestTriangle::kNone) continue;
    const Vec3& a = search.limit.triangles.corner(f, 0);
    const Vec3 normal =
        (search.limit.triangles.corner(f, 1) - a).cross(search.limit.triangles.corner(f, 2) - a);
    const double length = normal.norm();
    if (!(length > 0)) continue;
    const Vec3 unit = normal / length;
    if (std::any_of(out.begin(), out.end(),
                    [&](const Vec3& n) { return std::abs(n.dot(unit)) > 1 - 0x1p-30; }))
      continue;
    out.push_back(unit);
    out.emplace_back(-unit);
  }
  return out;
}

/// The part of a convex polygon where side · x[axis] ≤ most.
std::vector<Vec3> clip(const std::vector<Vec3>& polygon, int axis, int side, double most) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double x = side * a[axis] - most, y = side * b[axis] - most;
    if (x <= 0) out.push_back(a);
    if ((x <= 0) == (y <= 0)) continue;
    const double t = x / (x - y);
    out.emplace_back((1 - t) * a + t * b);
  }
  return out;
}

/// Corners of what faces have in the box, a little enlarged. False when they are too many.
bool points_in(const RegionSearch& search, const Bounds& box, const BoxTree& tree,
               std::vector<Vec3>& points) {
  std::size_t count = 0;
  tree.query([&](const Bounds& b) { return count <= kMaxFaces && b.meets(box); },
             [&](std::uint32_t f) {
               if (++count > kMaxFaces) return;
               std::vector<Vec3> polygon{search.limit.triangles.corner(f, 0),
                                         search.limit.triangles.corner(f, 1),
                                         search.limit.triangles.corner(f, 2)};
               for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
                 polygon = clip(polygon, axis, 1, box.high[axis] + 2 * search.slack);
                 polygon = clip(polygon, axis, -1, -box.low[axis] + 2 * search.slack);
               }
               points.insert(points.end(), polygon.begin(), polygon.end());
             });
  return count <= kMaxFaces;
}

/// A height below which, along the normal, the box has none of the faces whose points these are,
/// and is not in Z: the box's part there is convex, so that a point of it tells.
/// @param kind  of the faces: 0, Z's boundary; 1, the outer chain's; 2, the inner one's
std::optional<double> free_below(const RegionSearch& search, const Bounds& box, const Vec3& p,
                                 const Vec3& normal, const std::vector<Vec3>& points,
                                 std::size_t kind) {
  double height = std::numeric_limits<double>::infinity();
  for (const Vec3& q : points) height = std::min(height, normal.dot(q - p));
  height -= 4 * search.slack;
  Vec3 lowest;
  for (int k = 0; k < 3; ++k) lowest[k] = normal[k] > 0 ? box.low[k] : box.high[k];
  const double below = normal.dot(lowest - p);
  if (!(height > below && below < 0)) return std::nullopt;
  // A point there, off the box's corner, where planes of round coordinates tend to meet.
  const double share = 0.4877 * std::min((height - below) / -below, 1.0);
  const Vec3 q = lowest + share * (p - lowest);
  const bool out = kind == 0   ? search.in_region(q) == std::optional(false)
                   : kind == 1 ? winding_at(search.meshes, kOutside, q).value_or(0) >= 1
                               : winding_at(search.meshes, kInside, q).value_or(1) < 1;
  if (!out) return std::nullopt;
  return std::min(height, 0x1p100) + normal.dot(p) - 2 * search.slack;
}

void keep_above(const Part& part, const Plane& plane, std::vector<Part>& out) {
  int above = 0;
  for (const Vec3& x : part.corners) above += plane.normal.dot(x) > plane.height ? 1 : 0;
  if (above == 4) out.push_back(part);
  if (above == 0 || above == 4) return;
  std::vector<Part> dropped;
  cut(part, plane, out, dropped);
}

}  // namespace

bool near_without_free(const RegionSearch& search, const Bounds& box, const Vec3& p,
                       std::uint32_t face, std::size_t& work) {
  work += kThinWork;
  const std::vector<Vec3> normals = directions(search, p, face);
  std::vector<Part> parts, next;
  for (const Tetrahedron& t : tetrahedra(box)) parts.push_back({t, 0});
  const std::array<const BoxTree*, 3> trees{&search.boundary, &search.meshes.tree(kOutside),
                                            &search.meshes.tree(kInside)};
  std::array<std::vector<Vec3>, 3> points;
  bool thinner = false;
  for (std::size_t k = 0; k < trees.size(); ++k) {
    if (!points_in(search, box, *trees[k], points[k])) continue;
    for (const Vec3& normal : normals) {
      const std::optional<double> height = free_below(search, box, p, normal, points[k], k);
      if (!height) continue;
      thinner = true;
      next.clear();
      for (const Part& part : parts) keep_above(part, {normal, *height}, next);
      parts.swap(next);
      if (parts.empty()) return true;
      if (parts.size() > kMaxParts) return false;
    }
  }
  return thinner && near_after_cuts(search, parts, face, work);
}

}  // namespace kaboum::verify
