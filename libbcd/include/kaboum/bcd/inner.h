#pragma once

#include <kaboum/bcd/balls.h>
#include <kaboum/bcd/cover.h>

#include <cstdint>

namespace kaboum::bcd {

/// Request for find_inner.
struct InnerOptions : SearchSettings, SearchRun {
  /// Triangles of the input that bound what an exact check of the result found outside the solid.
  /// Where they meet others, more is kept clear of.
  std::vector<std::uint32_t> doubtful;
};

/// Request for find_inner_balls.
struct InnerBallOptions : SearchRun {
  /// Most balls: alone, the least epsilon found for which so many are enough; with epsilon, fewest
  /// balls within it and, if these are too many, that least one.
  std::optional<std::size_t> max_bodies;
  Effort effort = Effort::Normal;
  std::vector<std::uint32_t> doubtful;  ///< as InnerOptions::doubtful
};

/// Result of find_inner and find_inner_balls. No claim that it lies inside: certify::certify_set
/// decides that.
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

/// Searches for few balls whose union lies inside the input's solid and leaves out no point deeper
/// than epsilon. Centres and radii are float32 numbers.
///
/// An octree's cubes are cut until each is outside, nowhere deeper, or in one ball: for one that is
/// in none yet, a ball that holds it is grown by steps that make it larger. Of all balls grown few
/// are chosen that hold the same cubes, by a local search with weights [gao2015].
/// docs/algorithms/sphere-covers.md, "Inside a solid".
///
/// No claim that they lie inside: certify::certify_set decides that. The same for any number of
/// threads.
///
/// @pre epsilon or max_bodies is given
/// @throws as find_inner; Error{LimitReached} where more than kMostBalls balls would be needed, or
///   the search for them would take too long
InnerCandidate find_inner_balls(const geom::SolidMesh& input, const InnerBallOptions& options);

}  // namespace kaboum::bcd
