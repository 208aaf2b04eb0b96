#pragma once

#include <kaboum/base/option.h>
#include <kaboum/engines/engine_world.h>

namespace kaboum::engines {

/// The options of who decides contacts: engine, engine-shapes, engine-step, package-path.
const std::vector<Option<EngineRequest>>& engine_options();

}  // namespace kaboum::engines
