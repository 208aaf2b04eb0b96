#pragma once

#include "count_search.h"
#include "epsilon_search.h"
#include "finish.h"
#include "search_state.h"

namespace kaboum::bcd {

/// Looks for bodies that have, all together, no more vertices than allowed.
class VertexBudget {
 public:
  VertexBudget(SearchState& state, CountSearch& count, EpsilonSearch& within, Finisher& finisher)
      : state_(state), count_(count), within_(within), finisher_(finisher) {}

  /// The bodies with the smallest distance found that keep to both limits; else those with the
  /// fewest vertices.
  std::vector<Finished> nearest_that_fit();

 private:
  std::vector<Finished> by_number(std::size_t most, std::size_t total);
  void by_distance(std::vector<Finished>& best, std::size_t most, std::size_t total);
  void simplify_to(std::vector<Finished>& bodies, std::size_t total);

  SearchState& state_;
  CountSearch& count_;
  EpsilonSearch& within_;
  Finisher& finisher_;
};

}  // namespace kaboum::bcd
