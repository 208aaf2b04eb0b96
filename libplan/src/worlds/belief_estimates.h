#pragma once

#include <cstdint>
#include <optional>

#include "worlds/knowledge_estimate.h"
#include "worlds/world_estimate.h"

namespace kaboum::plan::worlds {

/// What orders a search for a weak plan.
enum class Guide : std::uint8_t {
  Worlds,    ///< relaxed plans of worlds taken as if they were known, and the number of worlds
  Knowledge  ///< relaxed plans for one goal after the other that find out what they need
};

/// The estimates of both guides.
class BeliefEstimates {
 public:
  static constexpr int kDead = WorldEstimate::kDead;

  static_assert(kDead == KnowledgeEstimate::kDead);

  BeliefEstimates(const BeliefSpace& space, Limits& limits)
      : space_(space), limits_(limits), worlds_(space) {}

  /// kDead: the belief has no plan. @throws LimitExceeded
  int operator()(Guide guide, const Word* belief) {
    if (guide == Guide::Worlds) return worlds_(belief);
    if (!knowledge_) knowledge_.emplace(space_, limits_);
    return (*knowledge_)(belief);
  }
  [[nodiscard]] std::size_t bytes() const { return worlds_.bytes(); }

 private:
  const BeliefSpace& space_;
  Limits& limits_;
  WorldEstimate worlds_;
  std::optional<KnowledgeEstimate> knowledge_;  ///< made when it is needed
};

}  // namespace kaboum::plan::worlds
