#pragma once

#include "search_space.h"

namespace kaboum::motion {

/// A path between the same ends that is no longer: waypoints are left out, then random shortcuts
/// are taken, each where it is free at every instant.
robot::Path shorten(robot::Path path, SearchSpace& space, std::size_t shortcuts, Random& random);

}  // namespace kaboum::motion
