#pragma once

#include "count_search.h"
#include "finish.h"
#include "local_search.h"
#include "search_state.h"

namespace kaboum::bcd {

/// Looks for few bodies within a given distance of the solid.
class EpsilonSearch {
 public:
  EpsilonSearch(SearchState& state, LocalSearch& local, CountSearch& count, Finisher& finisher)
      : state_(state), local_(local), count_(count), finisher_(finisher) {}

  /// Bodies within epsilon, one only where that suffices; none when even the first are more than
  /// `most`.
  std::vector<Finished> within(double epsilon, std::size_t most = kUnlimited);

  /// Looks for fewer bodies within epsilon, by bisection of the number allowed, until there are
  /// `enough`; one alone has been tried.
  void reduce(std::vector<Finished>& bodies, double epsilon, std::size_t enough = 1);

 private:
  std::vector<Finished> hull_within(double epsilon);
  void cut_until(double distance, std::size_t most_leaves, double begin, double aim);
  void split_far(std::vector<Body>& bodies, double epsilon, std::size_t most);
  std::vector<Finished> finish_until_within(std::vector<Body> bodies, double epsilon,
                                            std::size_t most);
  bool replace(std::vector<Finished>& bodies, std::size_t target, double epsilon);

  SearchState& state_;
  LocalSearch& local_;
  CountSearch& count_;
  Finisher& finisher_;
};

}  // namespace kaboum::bcd
