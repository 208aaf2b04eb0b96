#pragma once

#include <kaboum/geom/mesh.h>

#include <Eigen/Core>

namespace kaboum::wrap {

using geom::Vec3;

/// Weighted sum of squared distances to planes. [length² · weight]
/// Source: [garland1997]. Coordinates are relative to a point near by, so that little cancels.
struct Quadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  double c = 0, weight = 0;

  /// The plane through p with the unit normal n.
  void add_plane(const Vec3& n, const Vec3& p, double w);
  /// The distance to a point, in all directions.
  void add_point(const Vec3& p, double w);
  Quadric& operator+=(const Quadric& other);
  [[nodiscard]] double at(const Vec3& p) const { return p.dot(a * p) + 2 * b.dot(p) + c; }
  /// The point with the smallest value; of several, one that is near to `p`.
  [[nodiscard]] Vec3 minimiser(const Vec3& p) const;
};

}  // namespace kaboum::wrap
