#pragma once

#include <cstdint>
#include <vector>

#include "decimation_state.h"
#include "measured_policy.h"

namespace kaboum::bmesh {

/// Moves vertices that float32 cannot hold to certified positions that it can.
class FloatSnap {
 public:
  FloatSnap(DecimationState& state, MeasuredPolicy& policy) : state_(state), policy_(policy) {}

  /// Moves them, or contracts them away. @return how many could not be helped.
  std::size_t run();

 private:
  [[nodiscard]] bool make_room(std::uint32_t v);
  [[nodiscard]] bool contract_away(std::uint32_t v);
  [[nodiscard]] bool move(std::uint32_t v, bool may_fold = false);

  DecimationState& state_;
  MeasuredPolicy& policy_;
  std::vector<std::uint32_t> removed_;
  std::vector<NewTriangle> added_;
};

}  // namespace kaboum::bmesh
