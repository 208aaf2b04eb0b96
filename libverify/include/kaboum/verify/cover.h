#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/distance.h>
#include <kaboum/verify/inclusion.h>

namespace kaboum::verify {

/// Result of verify_convexity.
struct Convexity {
  /// Every core is a closed chain of positive volume with no vertex above any of its planes or,
  /// with a radius above 0, a segment or a point.
  Claim convex;
  /// Indices of the bodies that are not, and why, in order.
  std::vector<std::pair<std::size_t, std::string>> not_convex;
};

/// Decides exactly whether all bodies of a set are convex.
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite.
Convexity verify_convexity(const geom::ConvexSet& set);

/// Result of verify_cover.
struct Cover {
  Convexity convexity;
  /// The claims about the original and the union; triangles of the outer mesh are counted through
  /// the bodies one after the other.
  Inclusion inclusion;
};

/// Decides exactly whether the bodies of a set are convex and their union covers the original: its
/// solid, without voids, and every one of its triangles.
///
/// The sum of the bodies' chains winds about a point as often as there are bodies that contain it,
/// so this is verify_inclusion(original, sum). With a margin m > 0 (geom::margin_of) the union is
/// that of all balls of radius m about points of the cores: what these leave out must be within m
/// of them. Where its distance is m but for rounding, or where it would take too long, the answer
/// is undecided.
///
/// Of bodies of several radii, or with segments and points as cores, it is verify_body_cover or
/// verify_ball_cover: exact, with polytopes for none of them
/// (docs/algorithms/capsules-and-boxes.md).
///
/// @throws as verify_inclusion
Cover verify_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                   const InclusionOptions& options = {});

/// Decides whether every point of the union lies in the original's solid, and no part of the bodies
/// out of it: what an inner set claims. Of balls that is verify_balls_within, exact; other bodies
/// with a radius are bounded by polytopes, and claims then name no triangles of them.
/// @throws as verify_inclusion
Inclusion verify_within(const geom::ConvexSet& set, const geom::Mesh& original,
                        const InclusionOptions& options = {});

/// Decides whether every point of the union, its radii included, is within `epsilon` of the
/// original's triangles or, with `to_solid`, of these or its solid.
///
/// To the solid of a set of polytopes, balls, capsules and rounded boxes: by cutting bodies into
/// cells (docs/algorithms/rounded-bodies.md, "Cells"). Of sets with one radius, where that does not
/// decide, it is verify_distance from the bodies' triangles with what ε leaves beside the margin,
/// and a search of what the bodies hold of the solid's outside (to the triangles alone, the inside
/// of bodies is not looked at). Where that fails, only a point of the union that is farther away
/// than ε refutes, since what the margin adds may be near another part of the original; undecided
/// where ε is no larger than the margin. Others are bounded by polytopes as in verify_cover.
///
/// `triangle` is that of sum_of(set) that is nearest to the point that refutes.
///
/// @pre epsilon > 0; with `to_solid` the original is a closed chain
/// @throws as verify_distance
DistanceClaim verify_excess(const geom::ConvexSet& set, const geom::Mesh& original, double epsilon,
                            bool to_solid, const InclusionOptions& limits = {});

/// Decides whether every point of the original's solid that is deeper than `epsilon` inside it
/// (farther from its boundary) is in a body: what an inner set promises besides lying within the
/// solid. A witness is in no body, and `depth` deeper than epsilon.
///
/// Distances are measured to the parts of triangles with an outside along them, and to places
/// outside. Where the deepest point is epsilon deep but for rounding, or it would take too long,
/// the answer is undecided. Undefined unless the original is a closed chain. Of balls it is
/// verify_ball_depth; other bodies with a radius are bounded by polytopes.
///
/// @pre epsilon > 0; the bodies are convex (verify_cover, `convex`)
/// @throws as verify_inclusion
Claim verify_depth(const geom::Mesh& original, const geom::ConvexSet& set, double epsilon,
                   const InclusionOptions& options = {});

/// The triangles of all bodies' cores in one mesh or, where radii differ or cores are segments and
/// points (no geom::margin_of), those of polytopes within the bodies.
geom::Mesh sum_of(const geom::ConvexSet& set);

}  // namespace kaboum::verify
