#pragma once

#include "finish.h"
#include "local_search.h"
#include "search_state.h"

namespace kaboum::bcd {

/// Looks for a given number of bodies, as near to the solid as can be.
class CountSearch {
 public:
  CountSearch(SearchState& state, LocalSearch& local, Finisher& finisher)
      : state_(state), local_(local), finisher_(finisher) {}

  /// At most `target` bodies, unless parts of the solid that do not touch are more.
  std::vector<Finished> at_most(std::size_t target);

  /// The same, not finished yet; none where twice `epsilon` is not reached.
  std::vector<Body> gather(std::size_t target, double epsilon = kUnbounded);

 private:
  std::vector<std::vector<Body>> cut_for(std::size_t target);
  std::vector<Body> best_merge(const std::vector<std::vector<Body>>& snapshots, std::size_t target,
                               double limit);
  bool improve(std::vector<Finished>& finished, std::size_t target, double free_cost);

  SearchState& state_;
  LocalSearch& local_;
  Finisher& finisher_;
};

/// Where a body goes farther than samples told, that place is looked at from now on. @return
/// whether it was one of the body before simplification.
bool add_witness(SearchState& state, const Finished& f);

}  // namespace kaboum::bcd
