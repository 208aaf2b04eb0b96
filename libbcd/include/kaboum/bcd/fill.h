#pragma once

#include <kaboum/bcd/decompose.h>

namespace kaboum::bcd {

/// Convex bodies whose union lies inside the input's solid.
///
/// Round the deepest point that is not in a body yet, a convex body is grown until triangles stop
/// it: each is kept out by a plane that touches it, nearest first, in the metric of an ellipsoid
/// fitted to the body before (after [deits2015]). That is repeated until no point of the solid
/// deeper than epsilon is left, or max_bodies is reached; where nothing is deeper, there
/// is no body. docs/algorithms/convex-decomposition.md,
/// "From inside".
///
/// Bodies are exactly convex, with float32 coordinates and at most max_vertices vertices; they
/// overlap. The reach of the result brackets the largest depth (distance to the
/// solid's complement) among the solid's points that are in no body. Its upper end is certified:
/// every point deeper than reach_upper is in a body; the lower one rests on sampled membership.
/// That the bodies lie inside is left to an exact check of what is written
/// (verify::verify_inclusion): it can fail where features of the input are as small as float32's
/// spacing. The same for any number of threads.
///
/// @pre input comes from geom::prepare; epsilon or max_bodies is given.
/// @throws Error{InvalidArgument} on contradictory options, and where `doubtful` names a triangle
/// that the mesh does not have; Error{InvalidInput} for open meshes, which have no inside.
DecomposeResult fill(const geom::Prepared& input, const DecomposeOptions& options);

}  // namespace kaboum::bcd
