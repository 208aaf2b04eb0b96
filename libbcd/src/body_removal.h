#pragma once

#include "finish.h"
#include "search_state.h"

namespace kaboum::bcd {

/// Removes bodies, small ones first, whose pieces their neighbours can take within epsilon; nothing
/// where the bodies are not within it. One body alone is not looked for.
void remove_bodies(SearchState& state, Finisher& finisher, std::vector<Finished>& bodies,
                   double epsilon);

}  // namespace kaboum::bcd
