// Things in regions, by outer and inner sets.

#include <kaboum/base/error.h>
#include <kaboum/world/regions.h>

#include "placement.h"

namespace kaboum::world {

collide::Inclusion find_inclusion(const Checker& checker, const WorldState& state, const Item& item,
                                  std::size_t region, std::size_t most_pieces) {
  const World& world = checker.world();
  if (region >= world.regions.size()) throw Error(ErrorCode::InvalidArgument, "no such region");
  const collide::PosedSet where = detail::place_of(world.regions[region]);
  for (const Checker::PosedItem& placed : checker.places(state))
    if (placed.item == item) return find_inclusion(placed.place, where, most_pieces);
  throw Error(ErrorCode::InvalidArgument, "no such item");
}

}  // namespace kaboum::world
