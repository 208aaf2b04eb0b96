#pragma once

#include <kaboum/collide/inclusion.h>
#include <kaboum/world/checker.h>
#include <kaboum/world/regions.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "common/report.h"

/// kaboum-check --inside: whether objects, links and robots lie in regions.
namespace kaboum::tools {

using Inside = world::InclusionQuestion;

/// What texts NAME=REGION ask for. Throws InvalidArgument where the scene has no such name,
/// InvalidInput where of a robot it cannot be told.
std::vector<Inside> parse_inside(const world::World& world, const std::vector<std::string>& texts);

/// Whether all that is asked for is inside; each answer is said and reported. `before` begins each
/// line.
collide::Inclusion decide_inside(const world::Checker& checker, const world::WorldState& state,
                                 const std::vector<Inside>& wanted, const std::string& before,
                                 const std::function<void(const std::string&)>& say, Json& report);

/// The same all along a motion of a robot, at every instant.
collide::Inclusion decide_inside(const world::Checker& checker, const world::WorldState& state,
                                 std::size_t robot, const robot::Path& path,
                                 const world::MotionOptions& options,
                                 const std::vector<Inside>& wanted,
                                 const std::function<void(const std::string&)>& say, Json& report);

}  // namespace kaboum::tools
