#pragma once

#include <kaboum/geom/convex_set.h>

#include <vector>

namespace kaboum::geom {

/// Points of the unit sphere, of length 1 at most: the corners of an icosahedron whose triangles
/// are divided into four, and those again.
struct SpherePoints {
  std::vector<Vec3> points;
  double inner = 1;  ///< their hull contains the ball of this radius: 1 − 0.2 / 4^level, about
};

/// @param level  of subdivision, 0 to 6: 12, 42, 162, 642, 2562, 10242, 40962 points
SpherePoints sphere_points(int level);

/// A polytope within a convex body: the hull of v + r · q over the core's vertices v and the points
/// q of the sphere, and of each facet moved out by the radius r. Pairs v, q that cannot matter are
/// left out. A body of radius 0 is its own polytope. docs/algorithms/rounded-bodies.md.
///
/// Every point of the body is within r · (1 − inner) and rounding of it. Rounding may move a vertex
/// out of the body, by 2^-52 of the coordinates and the radius; who needs to know decides exactly.
/// @return without triangles where the radius is too small for the coordinates' digits
/// @pre the body is convex (is_convex)
Mesh inscribed_polytope(const ConvexBody& body, const SpherePoints& sphere);

/// A polytope round a convex body: the hull of v + s · q with s = r / inner, a little more for
/// rounding. Every point of it is within r · (1 / inner − 1), and rounding, of the body. That it
/// holds the body is for who needs it to decide exactly (verify::verify_holding).
/// @pre the body is convex (is_convex)
Mesh circumscribed_polytope(const ConvexBody& body, const SpherePoints& sphere);

/// Triangles to look at: a body's facets or, where its radius is above 0, those of a polytope round
/// it that reaches beyond it by 1.3 % of the radius at most.
Mesh surface_of(const ConvexBody& body);

}  // namespace kaboum::geom
