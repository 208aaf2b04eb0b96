#pragma once

#include <kaboum/world/checker.h>

#include <vector>

namespace kaboum::page {

/// A PNG of the bounding sets of a world in a state: robots grey, objects blue, what is in contact
/// orange, and the bodies that meet red. Margins are not drawn.
std::vector<char> picture_of(const world::Checker& checker, const world::WorldState& state,
                             const std::vector<world::Contact>& contacts);

}  // namespace kaboum::page
