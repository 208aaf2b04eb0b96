#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "search/relaxation.h"

namespace kaboum::plan {

/// Actions by number, a bit for each.
using ActionSet = std::vector<std::uint64_t>;

/// An occurrence of some action that every plan from the state at hand must contain.
struct LandmarkEvent {
  bool last = false;  ///< last achievement of a goal; else first of `facts`
  std::vector<FactId> facts;
  ActionSet actions;                         ///< that it may be an occurrence of
  std::vector<FactId> conditions;            ///< that all of them need
  std::vector<std::vector<FactId>> options;  ///< each needs a fact among each of these
};

/// In every plan one event does not come after, or (strict) comes before, another.
struct EventOrder {
  Index before = 0, after = 0;  ///< events
  bool strict = false;
};

/// Lower bound on the cost of a plan with these events; nullopt: they contradict each other.
/// The two bounds of docs/planning/search.md, "Landmark events"; the larger.
/// @param costs  by number of the action.
std::optional<std::uint64_t> event_bound(const std::vector<LandmarkEvent>& events,
                                         const std::vector<EventOrder>& orders,
                                         const std::vector<std::int64_t>& costs);

/// How many events at least are different ones, those of few steps chosen first; nullopt as above.
std::optional<std::uint64_t> distinct_events(const std::vector<LandmarkEvent>& events,
                                             const std::vector<EventOrder>& orders);

}  // namespace kaboum::plan
