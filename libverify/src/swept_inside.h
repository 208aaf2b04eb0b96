#pragma once

#include <kaboum/verify/sweep.h>

#include "swept_body.h"

namespace kaboum::verify {

/// Whether the mesh's triangles form a closed chain.
bool is_closed(const geom::Mesh& mesh);

/// Decides whether the solid of a closed mesh is within the set's margin during the path, when its
/// triangles are known to be: decided at one configuration, that holds at all of them, because what
/// is outside the set would have to pass the surface to get in.
/// @param bodies  of the set, in order
Claim verify_inside(const MovingShape& shape, const std::vector<std::vector<double>>& path,
                    const geom::ConvexSet& set, const std::vector<SweptBody>& bodies,
                    const SweepOptions& options);

}  // namespace kaboum::verify
