#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/inclusion.h>

namespace kaboum::verify {

/// Decides whether every ball of a set lies in the solid of a mesh: its centre does, and no
/// triangle that bounds the solid has a point inside the ball. Exact: a ball may touch triangles.
/// The numbers of mesh and balls are taken as they are.
///
/// Triangles that have the solid on both sides bound nothing. Where a triangle bounds it in part
/// and has a point inside the ball, the part's corners are rounded; what depends on that rounding
/// is undecided (docs/algorithms/sphere-covers.md).
///
/// Both claims of the result are this one, since balls are no thinner than their triangles: there
/// are none. They are undefined for a mesh that is not closed. `outer_triangles` are the mesh's.
///
/// @pre is_set_of_balls(set)
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite.
Inclusion verify_balls_within(const geom::ConvexSet& set, const geom::Mesh& original,
                              const InclusionOptions& options = {});

/// verify_depth of a set of balls, by boxes: each lies in one ball, outside the solid, or nowhere
/// deeper than epsilon; or it is halved. Where balls leave no slack, or the deepest point that is
/// in none is epsilon deep but for rounding, the answer is undecided.
///
/// @pre is_set_of_balls(set); epsilon > 0
/// @throws as verify_balls_within
Claim verify_ball_depth(const geom::Mesh& original, const geom::ConvexSet& set, double epsilon,
                        const InclusionOptions& options = {});

}  // namespace kaboum::verify
