#pragma once

#include <atomic>
#include <limits>
#include <vector>

#include "allowance.h"
#include "arrangement.h"
#include "cell_sample.h"

namespace kaboum::verify {

inline constexpr int kCut = std::numeric_limits<int>::min();  // no one value: the face is cut

/// Per face of a chain the winding number that `value` finds on one side, for faces that the chains
/// of `mask` leave whole; kCut for the others, for faces without area, and for those
/// that the allowance leaves undone.
template <class Value>
std::vector<int> uncut_values(const Arrangement& arrangement, int chain, OperandMask mask,
                              Side side, const Value& value, std::atomic<std::size_t>& samples,
                              Allowance& allowance) {
  const MeshPair& meshes = arrangement.meshes();
  const std::uint32_t begin = meshes.begin(chain), count = meshes.count(chain);
  const std::vector<std::uint32_t> patch = patches(arrangement, chain, mask, side);
  std::vector<int> result(count, kCut);
  std::vector<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (patch[i] == i && meshes.face(begin + i).axis >= 0 && arrangement.uncut(begin + i, mask)) {
      roots.push_back(i);
    }
  }
  allowance.loop(roots.size(), [&](std::size_t r) {
    const CellSample sample = middle_sample(begin + roots[r]);
    result[roots[r]] = value(sample);
  });
  samples += roots.size();
  for (std::uint32_t i = 0; i < count; ++i) result[i] = result[patch[i]];
  return result;
}

}  // namespace kaboum::verify
