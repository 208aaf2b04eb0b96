#include "invariants.h"
#include "landmarks.h"
#include "relaxation.h"
#include "relaxed_plan.h"
#include "search.h"

namespace kaboum::plan {

Heuristics::Heuristics() = default;
Heuristics::~Heuristics() = default;

}  // namespace kaboum::plan
