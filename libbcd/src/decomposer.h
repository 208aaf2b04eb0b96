#pragma once

#include "count_search.h"
#include "epsilon_search.h"
#include "finish.h"
#include "local_search.h"
#include "search_state.h"
#include "vertex_budget.h"

namespace kaboum::bcd {

/// One search for bodies round a solid, by what the options ask for.
class Decomposer {
 public:
  /// Keeps references to the mesh and the options, which must outlive this object.
  /// @param work  allowed. [ns]
  Decomposer(const Mesh& closed, const CoverOptions& options, double work, Tuning how);
  Decomposer(const Mesh& closed, const CoverOptions& options, double work);
  /// The search that the constructors above give for the same but `options`, which ask for another
  /// number of bodies, and `work`: it gives the same result, sooner.
  Decomposer(const Decomposer& same, const CoverOptions& options, double work);
  Decomposer(const Decomposer&) = delete;
  Decomposer& operator=(const Decomposer&) = delete;
  ~Decomposer() = default;

  /// Stop::TooManyBodies, and no bodies, where epsilon asks for more than the limits allow.
  CoverCandidate run();

  [[nodiscard]] std::uint64_t work_done() const { return state_.solid().work().done(); }

 private:
  [[nodiscard]] std::size_t hopeless() const;
  [[nodiscard]] std::size_t fewest_possible(const std::vector<Finished>& bodies) const;
  std::vector<Finished> within_epsilon();
  [[nodiscard]] Stop stop_within(const std::vector<Finished>& bodies) const;

  SearchState state_;
  LocalSearch local_{state_};
  Finisher finisher_{state_};
  CountSearch count_{state_, local_, finisher_};
  EpsilonSearch within_{state_, local_, count_, finisher_};
  VertexBudget budget_{state_, count_, within_, finisher_};
};

}  // namespace kaboum::bcd
