#pragma once

#include <kaboum/geom/mesh.h>

#include <optional>
#include <span>
#include <vector>

namespace kaboum::bcd {

/// A box round points along axes of its own.
struct PrincipalBox {
  geom::Vec3 mean = geom::Vec3::Zero();
  Eigen::Matrix3d axes;  ///< columns, orthonormal up to rounding
  geom::Vec3 low, high;  ///< extent along the axes, from the mean

  /// Of the box enlarged by `margin` on every side.
  [[nodiscard]] std::vector<geom::Vec3> corners(double margin = 0) const;
};

/// The box round points along these axes.
PrincipalBox box_along(std::span<const geom::Vec3> points, const Eigen::Matrix3d& axes);

/// The box along the axes of the points' covariance, variances ascending.
/// @return nullopt without points, or when their covariance overflows.
std::optional<PrincipalBox> principal_box(std::span<const geom::Vec3> points);

}  // namespace kaboum::bcd
