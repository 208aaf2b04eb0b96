#pragma once

#include <optional>

#include "task/solve_limits.h"
#include "worlds/world_task.h"

namespace kaboum::plan::worlds {

/// The model as a task about possible worlds. nullopt: it has external functions or handles, senses
/// under a condition of the world, or grounds to more than is tried.
std::optional<WorldTask> ground_worlds(const Model& model, Limits& limits);

}  // namespace kaboum::plan::worlds
