#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::geom {

/// The affine map p ↦ linear · p + translation; for poses, `linear` is a rotation up to rounding.
struct Transform {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Vec3 translation = Vec3::Zero();
};

inline Vec3 operator*(const Transform& t, const Vec3& p) { return t.linear * p + t.translation; }

/// First b, then a.
inline Transform operator*(const Transform& a, const Transform& b) {
  return {a.linear * b.linear, a.linear * b.translation + a.translation};
}

}  // namespace kaboum::geom
