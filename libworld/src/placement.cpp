// Bounds of how far places are from where they are computed to be.

#include "placement.h"

#include <kaboum/geom/convex_hull.h>

#include <algorithm>

namespace kaboum::world::detail {

// docs/scene.md, "Errors of places": for a matrix L there is a rotation R with |L − R| ≤ |LᵀL − I|
// (Frobenius); 2^-46 is for the rounding of that, of a product, and of the angles or the quaternion
// that it was computed from.
double rotation_error(const Transform& pose, double radius) {
  if (pose.linear.isIdentity(0)) return 0;
  const double defect =
      (pose.linear.transpose() * pose.linear - Eigen::Matrix3d::Identity()).norm();
  return (defect + 0x1p-46) * (1 + 0x1p-40) * radius;
}

double attachment_error(const Transform& pose, double radius) {
  return (rotation_error(pose, radius) + 0x1p-47 * (pose.translation.norm() + radius)) *
         (1 + 0x1p-40);
}

double radius_of(const BoundingSet& set) {
  double most = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    for (const Vec3& p : set.body(i).core.vertices)
      most = std::max(most, p.norm() + set.body(i).radius);
  }
  return most * (1 + 0x1p-40);
}

std::vector<Vec3> hull_points(const BoundingSet& set) {
  constexpr std::size_t kVeryMany = 4096;
  if (set.is_cloud() && set.size() > kVeryMany) {
    const geom::Box3& box = set.box();
    std::vector<Vec3> corners;
    for (unsigned k = 0; k < 8; ++k)
      corners.emplace_back((k & 1U) != 0 ? box.max.x() : box.min.x(),
                           (k & 2U) != 0 ? box.max.y() : box.min.y(),
                           (k & 4U) != 0 ? box.max.z() : box.min.z());
    return corners;
  }
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < set.size(); ++i)
    points.insert(points.end(), set.body(i).core.vertices.begin(), set.body(i).core.vertices.end());
  if (const auto hull = geom::convex_hull(points)) return hull->vertices;
  return points;
}

double placement_error(const sweep::MotionBounds& bounds, const Transform& base) {
  const double extent = bounds.extent();
  return (bounds.error(0) + 0x1p-48 * (extent + base.translation.norm()) +
          rotation_error(base, extent)) *
         (1 + 0x1p-40);
}

collide::PosedSet place_of(const Region& region) {
  return collide::PosedSet(region.inner, region.pose,
                           rotation_error(region.pose, radius_of(region.inner)));
}

}  // namespace kaboum::world::detail
