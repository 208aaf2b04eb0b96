#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/inclusion.h>

namespace kaboum::verify {

/// Decides whether a union of convex bodies, each a core and a radius, contains every triangle of a
/// mesh and, where the mesh is a closed chain, its solid; exact. The numbers of mesh and bodies are
/// taken as they are.
///
/// Triangles are cut until each part has its corners in one body. Of the solid, what is left out
/// would have a local maximum of the distance from the bodies, which is sought in boxes. Bodies
/// that leave no slack end in Undecided (docs/algorithms/capsules-and-boxes.md).
///
/// Looks at no more parts than options.max_cells. Where triangles are left out, the solid claim is
/// refuted only if a point of it with double coordinates is found in no body.
///
/// @pre every body is convex (geom::is_convex)
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite.
Inclusion verify_body_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                            const InclusionOptions& options = {});

}  // namespace kaboum::verify
