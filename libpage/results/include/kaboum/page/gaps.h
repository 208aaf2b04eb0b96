#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/triangle_search.h>

#include <functional>
#include <span>

#include <kaboum/page/preview.h>

/// Distances to be looked at, on triangles cut small enough for that.
namespace kaboum::page {

/// How far a point is from something; called by several threads.
using DistanceOf = std::function<double(const geom::Vec3&)>;

/// Upper bounds of the distance from the triangles, within rounding of the distance.
DistanceOf distance_to(const geom::DistanceQuery& triangles);

/// A mesh, cut into triangles that are small in comparison with `extent`, with the distances of
/// their corners.
Shape measured(const geom::Mesh& mesh, double extent, const DistanceOf& distance);

/// Bodies the same way, `distances[i]` for the body i. Of corners within other bodies nothing is
/// said: they are not on the surface of the union.
std::vector<Shape> measured(std::span<const geom::ConvexBody> bodies, double extent,
                            std::span<const DistanceOf> distances);

}  // namespace kaboum::page
