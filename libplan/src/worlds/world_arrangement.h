#pragma once

#include "task/solve_limits.h"
#include "worlds/world_task.h"

namespace kaboum::plan::worlds {

/// Leaves out operators and steps that no world can reach (delete relaxation), finds what may
/// differ between worlds and what of it depends on each other, and gives each variable its place.
void arrange_worlds(WorldTask& task, Limits& limits);

}  // namespace kaboum::plan::worlds
