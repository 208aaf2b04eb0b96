#pragma once

#include <kaboum/sweep/motion.h>
#include <kaboum/world/world.h>

#include <span>
#include <vector>

namespace kaboum::world::detail {

/// How far the nearest exact rotation may take points within `radius` from where the matrix does.
double rotation_error(const Transform& pose, double radius);

/// The same for what is held with a pose in a link's frame, and the rounding of the product of
/// both.
double attachment_error(const Transform& pose, double radius);

/// Largest distance of a point of the set from its frame's origin, rounded up, margins included.
double radius_of(const BoundingSet& set);

/// Vertices of the hull of the set's bodies, which bounds of motions need only; of a cloud of very
/// many points the corners of its box, which hold the hull.
std::vector<Vec3> hull_points(const BoundingSet& set);

/// How far the computed place of a body on a link may be from the exact one: of kinematics with
/// these bounds, of the base's pose and of their product. [length]
double placement_error(const sweep::MotionBounds& bounds, const Transform& base);

/// A region's inner set where it is. Refers to the region.
collide::PosedSet place_of(const Region& region);

}  // namespace kaboum::world::detail
