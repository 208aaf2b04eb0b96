#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/inclusion.h>

namespace kaboum::verify {

/// True if the set has bodies and each is a ball: its core a point, its radius above 0 and finite.
bool is_set_of_balls(const geom::ConvexSet& set);

/// Decides whether a union of closed balls contains every triangle of a mesh and, where the mesh is
/// a closed chain, its solid; exact. The numbers of mesh and balls are taken as they are.
///
/// Triangles are cut until each part has its corners in one ball. Of the solid, what is left out
/// would have a local maximum of the least power of the balls, which is sought in boxes. Touching
/// balls that leave no slack end in Undecided (docs/algorithms/sphere-covers.md).
///
/// Looks at no more parts than options.max_cells. Where triangles are left out, the solid claim is
/// refuted only if a point of it with double coordinates is found in no ball.
///
/// @pre is_set_of_balls(set)
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite.
Inclusion verify_ball_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                            const InclusionOptions& options = {});

/// How much of the triangles of a mesh lies outside a union of balls.
struct OutsideBalls {
  double area = 0;                          ///< of all triangles, rounded [length²]
  double share_lower = 0, share_upper = 0;  ///< of it, outside
  double depth_lower = 0, depth_upper = 0;  ///< largest distance of a point from the union [length]
  geom::Vec3 at = geom::Vec3::Zero();       ///< a point at depth_lower, where that is above 0
};

/// Brackets, by branch and bound over parts of triangles; narrowed to 0.2 % of the area and 0.1 %
/// of the depth where 2^20 parts suffice. Triangles without area have no share.
/// @pre every body is a ball (is_set_of_balls), or there are none: then all is outside, at an
///   infinite depth
/// @throws as verify_ball_cover
OutsideBalls measure_outside_balls(const geom::Mesh& mesh, const geom::ConvexSet& set);

/// Parts of a mesh's triangles.
struct SplitMesh {
  geom::Mesh held, outside;
};

/// A mesh, cut where it leaves a union of balls; for pictures.
/// @param size  parts that a ball of this radius holds are not cut further [length]
/// @param most  about so many parts at the most
/// @pre as measure_outside_balls
SplitMesh split_by_balls(const geom::Mesh& mesh, const geom::ConvexSet& set, double size,
                         std::size_t most);

}  // namespace kaboum::verify
