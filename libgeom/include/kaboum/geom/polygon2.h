#pragma once

#include <Eigen/Core>

#include <vector>

/// Convex polygons in a plane, in double precision: results are rounded.
namespace kaboum::geom {

using Vec2 = Eigen::Vector2d;

/// The corners of a convex polygon, counterclockwise. Fewer than three: it has no area.
using Polygon2 = std::vector<Vec2>;

/// The z component of the cross product: above 0 if b is on the left of a.
double cross(const Vec2& a, const Vec2& b);

/// The convex hull of points, without corners between two others of one line (Andrew 1979, monotone
/// chain).
Polygon2 convex_hull(std::vector<Vec2> points);

/// The part of a polygon on the left of a line.
Polygon2 left_of(const Polygon2& polygon, const Vec2& from, const Vec2& along);

/// The common part of two polygons (Sutherland and Hodgman 1974).
Polygon2 common_part(Polygon2 a, const Polygon2& b);

/// The part of a polygon that is so far from its edges, or farther. [length]
Polygon2 eroded(const Polygon2& polygon, double by);

/// Whether a point is inside, and at least so far from the line of every edge. Points of which that
/// holds make a convex set. [length]
bool holds(const Polygon2& polygon, const Vec2& p, double inside);

/// The least distance of two parallel lines with all of the polygon between them; 0 if it has no
/// area. [length]
double width_of(const Polygon2& polygon);

struct Centroid {
  Vec2 place = Vec2::Zero();
  double area = 0;
};
Centroid centroid_of(const Polygon2& polygon);

/// How far a ray from a point within a polygon reaches, in lengths of `along`.
double reach_within(const Polygon2& polygon, const Vec2& from, const Vec2& along);

/// The direction of the longest edge, of length 1; of several the first.
Vec2 longest_edge(const Polygon2& polygon);

}  // namespace kaboum::geom
