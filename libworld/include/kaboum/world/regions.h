#pragma once

#include <kaboum/collide/inclusion.h>
#include <kaboum/world/checker.h>

namespace kaboum::world {

/// Whether an item lies in a region of the world in a state: its outer set, wherever errors of
/// places may put it, in the union of the region's inner set (Definition 1 of [gaschler2016], case
/// 4; docs/algorithms/bounded-predicates.md). Included is certain; what is in the region's solid by
/// more than `tolerance_of_inclusion` is found to be.
/// @param most_pieces  that bodies are cut into before it is given up.
/// @throws as Checker::find_contact; Error{InvalidArgument} for items and regions that are not of
///   the world.
collide::Inclusion find_inclusion(const Checker& checker, const WorldState& state, const Item& item,
                                  std::size_t region, std::size_t most_pieces = 10'000);

}  // namespace kaboum::world
