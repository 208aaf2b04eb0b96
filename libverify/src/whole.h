#pragma once

#include <atomic>
#include <limits>
#include <vector>

#include "allowance.h"
#include "arrangement.h"
#include "spot.h"

namespace kaboum::verify {

inline constexpr int kCut = std::numeric_limits<int>::min();  // no one value: the face is cut

/// Per face of a chain the winding number that `value` finds on one side, for faces that the chains
/// of `mask` leave whole; kCut for the others, for faces without area, and for those
/// that the allowance leaves undone.
template <class Value>
std::vector<int> whole_values(const Arrangement& arrangement, int chain, ChainMask mask, Side side,
                              const Value& value, std::atomic<std::size_t>& samples,
                              Allowance& allowance) {
  const Scene& scene = arrangement.scene();
  const std::uint32_t begin = scene.begin(chain), count = scene.count(chain);
  const std::vector<std::uint32_t> patch = patches(arrangement, chain, mask, side);
  std::vector<int> result(count, kCut);
  std::vector<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (patch[i] == i && scene.face(begin + i).axis >= 0 && arrangement.whole(begin + i, mask)) {
      roots.push_back(i);
    }
  }
  allowance.loop(roots.size(), [&](std::size_t r) {
    const Spot spot = middle_spot(begin + roots[r]);
    result[roots[r]] = value(spot);
  });
  samples += roots.size();
  for (std::uint32_t i = 0; i < count; ++i) result[i] = result[patch[i]];
  return result;
}

}  // namespace kaboum::verify
