#pragma once

#include <kaboum/geom/mesh.h>

#include <Eigen/Dense>

namespace kaboum::io {

/// x ↦ linear·x + translation, in rounded double precision; exact where it is the identity. The
/// place of a node's shapes in its scene. Internal to kaboum_io.
struct Placement {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  geom::Vec3 translation = geom::Vec3::Zero();

  [[nodiscard]] bool is_identity() const {
    return linear == Eigen::Matrix3d::Identity() && translation == geom::Vec3::Zero();
  }
  [[nodiscard]] bool mirrors() const { return linear.determinant() < 0; }
  [[nodiscard]] geom::Vec3 operator*(const geom::Vec3& p) const {
    if (linear == Eigen::Matrix3d::Identity()) return p + translation;
    return linear * p + translation;
  }
  [[nodiscard]] Placement operator*(const Placement& inner) const {
    if (is_identity()) return inner;
    if (inner.is_identity()) return *this;
    return {linear * inner.linear, *this * inner.translation};
  }
};

}  // namespace kaboum::io
