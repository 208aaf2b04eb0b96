#pragma once

#include <utility>
#include <vector>

#include "worlds/world_task.h"

namespace kaboum::plan::worlds {

/// A variable and a value.
using Literal = std::pair<Index, Index>;

/// Sets of literals one of which a condition needs, at most 16; what says nothing of one world, and
/// what would make more, is left out. None: the condition never holds.
std::vector<std::vector<Literal>> alternatives(const WorldTask& task, const Condition& c);

/// The same for several conditions that all have to hold.
std::vector<std::vector<Literal>> alternatives(const WorldTask& task,
                                               const std::vector<const Condition*>& all);

}  // namespace kaboum::plan::worlds
