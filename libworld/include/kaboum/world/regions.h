#pragma once

#include <kaboum/collide/inclusion.h>
#include <kaboum/world/motion_check.h>

#include <string>
#include <vector>

namespace kaboum::world {

/// Decides whether an item lies in a region of the world in a state: its outer set, wherever errors
/// of places may put it, in the union of the region's inner set (Definition 1 of [gaschler2016],
/// case 4; docs/algorithms/bounded-predicates.md). Included is certain; what is in the region's
/// solid by more than `tolerance_of_inclusion` is found to be.
/// @param most_pieces  that bodies are cut into before it is given up.
/// @throws as Checker::find_contact; Error{InvalidArgument} for items and regions that are not of
///   the world.
collide::Inclusion find_inclusion(const Checker& checker, const WorldState& state, const Item& item,
                                  std::size_t region, std::size_t most_pieces = 10'000);

struct MotionInclusion {
  collide::Inclusion answer = collide::Inclusion::Included;  ///< at every instant
  /// Place where it stops being certain: a segment from waypoint i to i + 1, and the share of it;
  /// all before is inside.
  std::size_t segment = 0;
  double share = 0;
  double found = 0;  ///< the share of the segment that was looked at when it did
  std::size_t intervals = 0;
};

/// Decides whether an item stays in a region while a robot moves along a path, at every instant. A
/// stretch of time is inside when the item is at its middle, enlarged by as much as it moves in
/// half of it (docs/scene.md); others are halved until it moves less than options.resolution.
/// @throws as check_motion and the one above.
MotionInclusion find_inclusion(const Checker& checker, const WorldState& state, std::size_t robot,
                               const robot::Path& path, const Item& item, std::size_t region,
                               const MotionOptions& options, std::size_t most_pieces = 10'000);

/// Question whether items lie in a region.
struct InclusionQuestion {
  std::string what, region_name;
  std::vector<Item> items;  ///< that `what` names
  std::size_t region = 0;
};

/// @param what  an object, a link ("ROBOT/LINK"), or a robot: all its links and what it carries.
/// @throws Error{InvalidArgument} where the world has no such name; Error{InvalidInput} for robots
///   that have links with shapes but no set.
InclusionQuestion inclusion_question(const World& world, const std::string& what,
                                     const std::string& region);

/// Decides whether all items of a question lie in its region: not, else undecided, else inside.
collide::Inclusion find_inclusion(const Checker& checker, const WorldState& state,
                                  const InclusionQuestion& question);
/// The same all along a motion of a robot; of the first item that stops being certainly inside.
/// @throws as find_inclusion of one item.
MotionInclusion find_inclusion(const Checker& checker, const WorldState& state, std::size_t robot,
                               const robot::Path& path, const InclusionQuestion& question,
                               const MotionOptions& options);

/// "inside", "not certainly inside", "undecided".
const char* name_of(collide::Inclusion answer);

/// Conjunction of several answers: not inside, else undecided, else inside.
void combine(collide::Inclusion& all, collide::Inclusion one);

}  // namespace kaboum::world
