#pragma once

#include <kaboum/certify/robot.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace kaboum::scene {

/// Knowledge of a robot's pairs of links, by their bodies.
struct RobotPairs {
  std::string srdf;  ///< <disable_collisions> of those that need no check
  std::size_t adjacent = 0, never = 0, fixed = 0;  ///< in the SRDF, by reason
  std::size_t others = 0;                          ///< that are to be checked
};

/// Pairs of links that need no check: connected ones, and those whose bodies are proved never to
/// touch within the limits (world::examine_pairs). Links that have shapes but no set are no frames:
/// their pairs are left to the checks, but for those that a joint connects or that are fixed.
/// @param progress  often called; what it throws ends the work
/// @throws Error{InvalidArgument} where sets of some links only were asked for
RobotPairs pairs_of(const robot::Robot& robot, const certify::CertifiedRobot& made,
                    const std::function<void()>& progress = {});

}  // namespace kaboum::scene
