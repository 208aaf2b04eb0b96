#pragma once

#include "finish.h"
#include "search_state.h"

namespace kaboum::bcd {

/// Removes bodies, small ones first, whose pieces their neighbours can take within epsilon; nothing
/// where the bodies are not within it. Fewer than `enough` are not looked for: two, since one has
/// been tried, or more where fewer are proved to be too few.
void remove_bodies(SearchState& state, Finisher& finisher, std::vector<Finished>& bodies,
                   double epsilon, std::size_t enough = 2);

}  // namespace kaboum::bcd
