#pragma once

#include <kaboum/base/option.h>
#include <kaboum/plan/solve.h>

namespace kaboum::plan {

/// A search as users state it: greedy, where they state no other.
struct SearchRequest : SolveOptions {
  SearchRequest() { algorithm = Algorithm::Greedy; }
};

/// The options of a search for a plan.
const std::vector<Option<SearchRequest>>& solve_options();

}  // namespace kaboum::plan
