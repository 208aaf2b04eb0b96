#pragma once

#include <kaboum/robot/robot.h>

#include <string>
#include <vector>

namespace kaboum::pairs {

/// A pair of links that needs no check.
struct UncheckedPair {
  std::uint32_t a, b;
  const char* reason;  ///< as MoveIt's assistant calls it: "Adjacent", "Never", "Default", "User"
};

/// An SRDF with a <disable_collisions> element for each pair.
std::string srdf_text(const robot::Robot& robot, const std::vector<UncheckedPair>& pairs);

}  // namespace kaboum::pairs
