#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::robot {

using geom::Vec3;
using Mat3 = Eigen::Matrix3d;

/// The affine map p ↦ linear · p + translation; for poses, `linear` is a rotation up to rounding.
struct Transform {
  Mat3 linear = Mat3::Identity();
  Vec3 translation = Vec3::Zero();
};

inline Vec3 operator*(const Transform& t, const Vec3& p) { return t.linear * p + t.translation; }

/// First b, then a.
inline Transform operator*(const Transform& a, const Transform& b) {
  return {a.linear * b.linear, a.linear * b.translation + a.translation};
}

/// Rotation by `angle` [rad] about a unit vector (Rodrigues).
Mat3 rotation_about(const Vec3& unit_axis, double angle);

/// Rz(yaw) · Ry(pitch) · Rx(roll): the convention of URDF and of the Robotics Library. [rad]
Mat3 rotation_from_rpy(double roll, double pitch, double yaw);

/// Denavit–Hartenberg parameters of one joint. [rad, length]
struct Dh {
  double theta = 0, d = 0, a = 0, alpha = 0;
};

/// Distal ("standard") convention: Rz(theta) · Tz(d) · Tx(a) · Rx(alpha).
Transform dh_distal(const Dh& p);

/// Proximal convention (Khalil–Kleinfinger, Craig): Rx(alpha) · Tx(a) · Rz(theta) · Tz(d).
Transform dh_proximal(const Dh& p);

}  // namespace kaboum::robot
