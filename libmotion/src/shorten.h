#pragma once

#include "search_space.h"

namespace kaboum::motion {

/// Leaves waypoints out: from each, the next one is the farthest that a straight line leads to.
robot::Path without_detours(const robot::Path& path, SearchSpace& space);

/// A path between the same ends that is no longer: waypoints are left out, then random shortcuts
/// are taken, each where it is free at every instant.
robot::Path shorten(robot::Path path, SearchSpace& space, std::size_t shortcuts, Random& random);

}  // namespace kaboum::motion
