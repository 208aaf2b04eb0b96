#pragma once

#include <kaboum/geom/transform.h>

namespace kaboum::robot {

using geom::Transform;
using geom::Vec3;
using Mat3 = Eigen::Matrix3d;

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
