#pragma once

#include <kaboum/geom/mesh.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace kaboum::bcd {

/// The points with n·p ≥ d.
struct HalfSpace {
  geom::Vec3 n = geom::Vec3::Zero();  ///< unit
  double d = 0;
  [[nodiscard]] double height(const geom::Vec3& p) const { return n.dot(p) - d; }
};

/// Beyond the triangle (a, b, c), on the side that sees it counter-clockwise; nothing for a sliver
/// that has no certain plane.
std::optional<HalfSpace> beyond_triangle(const geom::Vec3& a, const geom::Vec3& b,
                                         const geom::Vec3& c);

/// Sum of weighted squared distances to planes: vᵀAv − 2bᵀv + c, without the constant.
struct PlaneQuadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  geom::Vec3 b = geom::Vec3::Zero();
  void add(const HalfSpace& h, double weight) {
    a += weight * h.n * h.n.transpose();
    b += weight * h.d * h.n;
  }
  void add(const PlaneQuadric& q) {
    a += q.a;
    b += q.b;
  }
};

/// The point with the least sum in all half-spaces, of which it may be out by `tolerance`. Nothing
/// where it is not found, because the quadric has no certain minimum or the half-spaces hardly
/// meet.
std::optional<geom::Vec3> minimise_beyond(const PlaneQuadric& q,
                                          const std::vector<HalfSpace>& half_spaces,
                                          double tolerance);

}  // namespace kaboum::bcd
