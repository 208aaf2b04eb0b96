#pragma once

#include <kaboum/motion/path_constraint.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::manipulation {

/// Constraints that the motions of an external function keep at every instant, beside being free:
/// those of what is carried (motion::carried_constraints), of `putUpright`, of what is pushed. A
/// motion that keeps them and is free does what the function's own motion does, with the same ends.
///
/// @param state  in which the robot begins the motion, with what it holds
/// @param path  of the function's motion
/// @param arguments  of the function's call
/// @return nullopt: nothing but the path itself is known to do: of `follow`, whose volume is asked
///   about besides, and of functions that are not those of bind_externals.
/// @throws Error{InvalidInput} for names that the world does not have
std::optional<std::vector<motion::PathConstraint>> kept_constraints(
    const world::World& world, const world::WorldState& state, std::size_t robot,
    const robot::Path& path, const std::string& function,
    const std::vector<std::string>& arguments);

}  // namespace kaboum::manipulation
