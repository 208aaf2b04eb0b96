#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::collide {

/// True if an axis separates two oriented boxes (the 15 of the separating axis theorem: S.
/// Gottschalk, M. C. Lin, D. Manocha: OBBTree, 1996). False where rounding could decide.
/// @param axes     of the second box, in the frame of the first one: columns, orthonormal.
/// @param between  from the first centre to the second one, in the frame of the first. [length]
/// @param a, b     half of the boxes' edges. [length]
bool boxes_are_apart(const Eigen::Matrix3d& axes, const geom::Vec3& between, const geom::Vec3& a,
                     const geom::Vec3& b);

}  // namespace kaboum::collide
