#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/picture/image.h>

namespace kaboum::picture {

/// The surfaces of a set's bodies, one after the other.
geom::Mesh surfaces_of(const geom::ConvexSet& set);

/// By which share of their distance from the middle bodies are moved apart, unless that is stated.
inline constexpr double kExplode = 0.5;

/// A set of bodies, one colour per body; with explode > 0 a second panel shows the bodies moved
/// away from the set's middle by that share of their distance from it.
/// @throws Error{InvalidArgument} for a negative share, or one above 10
Image draw_bodies(const geom::ConvexSet& set, double explode = kExplode);

}  // namespace kaboum::picture
