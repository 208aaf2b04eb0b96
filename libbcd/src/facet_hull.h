#pragma once

#include <kaboum/geom/mesh.h>

#include <span>

namespace kaboum::bcd {

/// Steps of the search for the planes of a facet_hull: each includes those before it.
enum class PlaneSteps {
  Removal,   ///< those that cost the least volume are left out
  Turning,   ///< those that stay are turned about the points where they touch
  Exchange,  ///< the one that saves least is exchanged for the one that saves most
};

/// A polytope of few facets round points: exactly convex, with float32 corners, it contains them
/// exactly. Its planes touch the hull of the points, up to rounding, and are chosen for a small
/// volume (docs/algorithms/convex-decomposition.md, "Few facets").
/// @param required  float32 points; at least one
/// @param most      facets (geom::float32_facet_count), ≥ 6
/// @param vertices  most vertices, ≥ 8
/// @throws Error{LimitReached} when coordinates exceed float32.
geom::Mesh facet_hull(std::span<const geom::Vec3> required, std::size_t most, std::size_t vertices,
                      PlaneSteps steps = PlaneSteps::Exchange);

}  // namespace kaboum::bcd
