// Convex parts of space, and how far hulls are from them.

#include <kaboum/geom/closest_point.h>
#include <kaboum/geom/region.h>

#include <algorithm>
#include <array>
#include <limits>

namespace kaboum::geom {
namespace {

/// The point of the hull that is least far along d, relative to the origin given.
Vec3 least_along(const Vec3& d, std::span<const Vec3> hull) {
  return *std::ranges::min_element(hull, {}, [&](const Vec3& p) { return d.dot(p); });
}

/// By planes that part the hull from the centre, square to the way to the nearest point of a
/// triangle of its points; that triangle takes in the point which is nearest along the plane.
double distance_from_point(const Vec3& center, std::span<const Vec3> hull) {
  constexpr int kSteps = 40;
  double best = -std::numeric_limits<double>::infinity();
  std::array<Vec3, 3> face{hull[0], hull[0], hull[0]};
  Vec3 at = hull[0];
  for (int step = 0; step < kSteps; ++step) {
    const double length = (at - center).norm();
    if (!(length > 0)) return std::max(best, 0.0);
    const Vec3 d = (at - center) / length, next = least_along(d, hull);
    best = std::max(best, d.dot(next - center));
    if (std::ranges::find(face, next) != face.end()) break;
    const std::array<Vec3, 3> before = face;
    double least = length;
    for (int k = 0; k < 3; ++k) {
      std::array<Vec3, 3> other = before;
      other[k] = next;
      const Vec3 nearest = closest_point(center, other[0], other[1], other[2]);
      if (!((nearest - center).norm() < least)) continue;
      least = (nearest - center).norm();
      at = nearest;
      face = other;
    }
    if (!(least < length)) break;
  }
  return best;
}

}  // namespace

Region box_region(const Box3& box) {
  Region out;
  for (int k = 0; k < 3; ++k) {
    out.sides.push_back({Vec3::Unit(k), box.max[k]});
    out.sides.push_back({-Vec3::Unit(k), -box.min[k]});
  }
  return out;
}

bool holds(const Region& region, const Vec3& p) {
  if (region.sides.empty()) return (p - region.center).norm() <= region.radius;
  return std::ranges::all_of(
      region.sides, [&](const HalfSpace& side) { return side.normal.dot(p) <= side.offset; });
}

double distance_from(const Region& region, std::span<const Vec3> hull) {
  if (region.sides.empty()) return distance_from_point(region.center, hull) - region.radius;
  double best = -std::numeric_limits<double>::infinity();
  for (const HalfSpace& side : region.sides)
    best = std::max(best, side.normal.dot(least_along(side.normal, hull)) - side.offset);
  return best;
}

std::vector<BoundedRegion> bounded(const std::vector<RequestedRegion>& regions, double diagonal) {
  std::vector<BoundedRegion> out;
  out.reserve(regions.size());
  for (const RequestedRegion& one : regions)
    out.push_back({one.name, one.region, one.epsilon.of(diagonal)});
  return out;
}

}  // namespace kaboum::geom
