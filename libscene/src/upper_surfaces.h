#pragma once

#include <vector>

#include "faces.h"

/// What things can be put on: level faces of convex sets that look up.
namespace kaboum::scene {

/// The level faces of a set that look up, in the order of its bodies.
///
/// A face is level within 0.001 rad. A body's top is level within ε as well, and then one level
/// face at the body's highest point: if at least nine tenths of the body, seen from above, are
/// within ε of that height, and its level faces have less than half of that area.
/// @param up  of unit length
std::vector<Face> level_faces(const Faces& faces, const Vec3& up);

/// A convex part of level faces that no other body of the set covers.
struct UpperSurface {
  std::vector<Vec3> outline;  ///< counterclockwise, seen from above
  Vec3 middle;
  Vec3 normal;
  double area = 0;
};

/// Convex parts of level faces, the largest first; no two have more than edges in common.
///
/// Faces in one plane count as one where their union is convex. What other bodies cover is cut off
/// along the edges of these. Each part is then taken smaller by `inset` all round, and left out
/// where nothing is left. docs/scene.md, "Grasps and places".
/// @param level  as level_faces
std::vector<UpperSurface> upper_surfaces(const Faces& faces, std::vector<Face> level, double inset);

/// True if a point is on a surface, or nearer to it than `within`.
bool is_on(const UpperSurface& surface, const Vec3& point, double within);

}  // namespace kaboum::scene
