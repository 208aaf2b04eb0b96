#pragma once

#include <cstdint>
#include <vector>

#include "body.h"

namespace kaboum::bcd {

/// Clusters of neighbouring triangles, for comparison with merging what cuts have parted. Source:
/// [mamou2009]: edges of the dual graph are contracted, that with the smallest sum of the cluster's
/// concavity and its shape factor first. The concavity is the distance from its hull to the solid.
///
/// @param target   contracts down to this many clusters, if they touch
/// @param epsilon  and none to a larger concavity. [length]
/// @return per triangle, the number of its cluster.
std::vector<std::uint32_t> cluster_triangles(const SolidField& solid, std::size_t target,
                                             double epsilon);

/// One body per cluster, round all leaves in which it has the largest area. Leaves without surface
/// go with the triangle nearest to them. So each leaf is in a body, and the bodies cover the solid.
std::vector<Body> bodies_of_clusters(const CutTree& tree, const SolidField& solid,
                                     const std::vector<std::uint32_t>& cluster);

}  // namespace kaboum::bcd
