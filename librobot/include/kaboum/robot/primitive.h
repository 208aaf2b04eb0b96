#pragma once

#include <kaboum/robot/robot.h>

#include <array>
#include <vector>

namespace kaboum::robot {

/// A sphere, capsule or box, and the angles that its rotation was made of (rotation_from_rpy).
struct Primitive {
  Geometry geometry;
  Vec3 rpy = Vec3::Zero();  ///< [rad]
};

/// The cylinder and the two spheres whose union is a capsule: the spheres' centres are the axis's
/// ends, rounded.
/// @pre shape is Capsule
std::array<Geometry, 3> parts_of_capsule(const Geometry& capsule);

/// Primitives as a format without capsules has them: a cylinder and two spheres for each.
std::vector<Primitive> without_capsules(const std::vector<Primitive>& primitives);

}  // namespace kaboum::robot
