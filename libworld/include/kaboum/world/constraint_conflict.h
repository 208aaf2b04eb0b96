#pragma once

#include <kaboum/world/world.h>

#include <cstddef>
#include <optional>
#include <vector>

/// Proofs that constraints cannot be met, wherever things are. docs/scene.md.
namespace kaboum::world {

/// Constraints of a set that no poses of the things meet at once, tolerances included: their
/// numbers, ascending; without any one of them nothing is proved. nullopt: no contradiction was
/// found, which does not say that there is none. Only those between the same two things are looked
/// at together. Things are taken to be anywhere, also where a robot does not get.
std::optional<std::vector<std::size_t>> find_contradiction(
    const std::vector<ToleratedConstraint>& constraints);

/// What contradicts what, and what to do.
std::string describe(const std::vector<ToleratedConstraint>& constraints,
                     const std::vector<std::size_t>& contradiction);

/// A point that is fixed to a link never comes farther away from the root of its robot; infinite
/// where a joint slides without limits. [length]
/// @param point  in the link's frame
double longest_reach(const RobotModel& robot, std::uint32_t link, const Vec3& point);

/// Whether a constraint cannot be met because the robot does not reach so far, whatever its joints
/// are.
/// @pre the first feature is fixed to a link of the robot, the second one to the world
bool is_beyond_reach(const RobotModel& robot, const ToleratedConstraint& constraint);

}  // namespace kaboum::world
