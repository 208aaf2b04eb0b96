#pragma once

#include <kaboum/certify/link_bodies.h>

#include <cstddef>

namespace kaboum::certify {

/// What is least over the links that spheres of a robot are shared out to. A link's distance is
/// that of the farthest point of its spheres from its shapes.
enum class SphereShare {
  Farthest,  ///< the largest distance of a link; with what is left, the mean of all
  Mean       ///< the mean of the links' distances
};

/// Epsilons of the links with which a robot's spheres, each link's as near as their number was
/// found to allow, are as many as stated, or fewer.
///
/// Begins with one epsilon for all links (epsilon_within). Then links are tried with other
/// epsilons, and of all that was found for each link the best choice within the number is taken. It
/// is the best one of what was looked at: a link's spheres may be more than one fewer or more for
/// the next epsilon.
///
/// @param request  of spheres, with `nearest`; else as for epsilon_within
/// @return for RobotRequest::epsilons, of all links that have spheres
/// @throws as epsilon_within
/// @pre spheres > 0
LinkEpsilons share_spheres(const robot::RobotFile& robot, const RobotRequest& request,
                           std::size_t spheres, SphereShare share, const SetCache* cache = nullptr,
                           const RobotHooks& hooks = {});

}  // namespace kaboum::certify
