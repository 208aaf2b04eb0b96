#pragma once

#include <kaboum/world/motion_check.h>

#include "moving_pairs.h"

namespace kaboum::world::detail {

/// What a checker's substitute says of a motion at samples. Free: of none of them does it find a
/// contact. The pairs are those of check_motions.
MotionAnswer sampled_motion(const Checker& checker, const WorldState& state,
                            const std::vector<MovingRobot>& robots, const MotionOptions& options);

/// Those of the things that it finds in the way at a sample, ascending.
std::vector<Item> sampled_obstacles(const Checker& checker, const WorldState& state,
                                    const MovingRobot& robot, const std::vector<Item>& things,
                                    const MotionOptions& options);

}  // namespace kaboum::world::detail
