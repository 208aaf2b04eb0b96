#pragma once

#include <kaboum/certify/robot.h>

#include <cstddef>
#include <string>
#include <vector>

#include "report.h"

namespace kaboum::tools {

/// What is known of a robot's pairs of links, by their bodies.
struct RobotPairs {
  std::string srdf;  ///< <disable_collisions> of those that need no check
  std::string words;
  std::size_t adjacent = 0, never = 0, fixed = 0;  ///< in the SRDF, by reason
  std::size_t others = 0;                          ///< that are to be checked
};

Json report_of(const RobotPairs& pairs);

/// Pairs of links that need no check: connected ones, and those whose bodies are proved never to
/// touch within the limits (world::examine_pairs).
/// @pre all links with shapes are among the certified ones
RobotPairs pairs_of(const robot::Robot& robot, const std::vector<certify::CertifiedLink>& links);

}  // namespace kaboum::tools
