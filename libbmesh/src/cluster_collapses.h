#pragma once

#include <span>
#include <unordered_map>

#include "decimation_state.h"

namespace kaboum::bmesh {

/// Contracts edges together with moves of the vertices around, where contractions alone are too
/// far from the original (Optimiser::collapse_with_neighbours).
class ClusterCollapses {
 public:
  explicit ClusterCollapses(DecimationState& state) : state_(state) {}

  /// What has failed on another mesh may succeed.
  void forget_failures() { failures_.clear(); }
  /// How many may fail: so many and more for each that does not, or any number.
  void be_patient();
  void be_endlessly_patient();
  [[nodiscard]] bool out_of_patience() const { return patience_ < 0; }

  /// Contracts down to `target` vertices, each within the limit. [length] What has failed is tried
  /// again when another such contraction around has succeeded, or the limit has risen to what it
  /// would have taken.
  void run(std::size_t target, double limit);

 private:
  struct Edge {
    double cost;
    std::uint32_t a, b;
  };
  struct Failure {
    std::uint32_t version = ~0U;  // of both ends
    double deviation = 0;         // that the contraction would take
  };
  [[nodiscard]] std::vector<Edge> edges_by_cost(double limit);
  [[nodiscard]] bool may_succeed(const Edge& e, double limit);
  void collapse_batch(std::span<const Edge> batch, double limit);

  DecimationState& state_;
  std::unordered_map<std::uint64_t, Failure> failures_;  // by edge
  std::vector<std::uint32_t> version_;  // of a vertex: raised by such contractions around it
  int patience_ = 0;                    // how many may fail yet
};

}  // namespace kaboum::bmesh
