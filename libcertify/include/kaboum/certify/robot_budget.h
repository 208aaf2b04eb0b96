#pragma once

#include <kaboum/certify/link_bodies.h>

#include <cstddef>
#include <optional>

namespace kaboum::certify {

/// Limits on all links of a robot together.
struct RobotBudget {
  std::optional<std::size_t> bodies, vertices;
};

/// The least epsilon, one length for all links, with which a robot's bodies were found to be within
/// a budget: bodies go where they are needed for that, and no link is coarser than it has to be.
/// Found by halving it from where one hull for each part suffices, to 1/2048 of that at the least,
/// and then within an octave; within 5 %, for what is there in between is not looked at.
///
/// @param request  without epsilon and limits of bodies; its own epsilons of links are refused
/// @return the request's epsilon, for certify_robot
/// @throws Error{InvalidArgument} where one hull for each part is more than the budget, saying how
///   many that are; what certify_bodies throws.
Length epsilon_within(const robot::RobotFile& robot, RobotRequest request,
                      const RobotBudget& budget, const SetCache* cache = nullptr,
                      const RobotHooks& hooks = {});

}  // namespace kaboum::certify
