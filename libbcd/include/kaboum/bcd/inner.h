#pragma once

#include <kaboum/bcd/cover.h>

#include <cstdint>

namespace kaboum::bcd {

/// Request for find_inner.
struct InnerOptions : SearchSettings, SearchRun {
  /// Triangles of the input that bound what an exact check of the result found outside the solid.
  /// Where they meet others, more is kept clear of.
  std::vector<std::uint32_t> doubtful;
};

/// Result of find_inner. No claim that it lies inside: certify::certify_set decides that.
struct InnerCandidate {
  std::vector<geom::ConvexBody> bodies;
  Stop stop = Stop::Done;
  /// Bracket of the largest depth (distance to the solid's complement) among the solid's points
  /// that are in no body. The upper end is certified: every point deeper than that is in a body;
  /// the lower one rests on sampled membership. [length]
  double uncovered_depth_lower = 0, uncovered_depth_upper = 0;
  std::size_t vertices = 0;  ///< of all bodies
  std::size_t largest = 0;   ///< vertices of the largest body
  bool out_of_work = false;  ///< max_work ended the search: with more, it might do better
};

/// Searches for convex bodies whose union lies inside the input's solid.
///
/// Round the deepest point that is not in a body yet, a convex body is grown until triangles stop
/// it. Each is kept out by a plane that touches it, nearest first, in the metric of an ellipsoid
/// fitted to the body before (after [deits2015]). That is repeated until no point of the solid
/// deeper than epsilon is left, or max_bodies is reached; where nothing is deeper, there is no
/// body. docs/algorithms/convex-decomposition.md, "From inside".
///
/// Bodies are exactly convex, with float32 coordinates and at most max_vertices vertices; they
/// overlap. That the bodies lie inside is left to an exact check of what is written
/// (verify::verify_inclusion): it can fail where features of the input are as small as float32's
/// spacing. The same for any number of threads.
///
/// @pre epsilon or max_bodies is given.
/// @throws Error{InvalidArgument} on contradictory options, and where `doubtful` names a triangle
/// that the mesh does not have; Error{InvalidInput} for open meshes, which have no inside.
InnerCandidate find_inner(const geom::SolidMesh& input, const InnerOptions& options);

}  // namespace kaboum::bcd
