#pragma once

#include <atomic>
#include <limits>
#include <vector>

#include <kaboum/verify/inclusion.h>

#include "allowance.h"
#include "arrangement.h"
#include "parallel.h"
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

/// Faces of a chain whose winding numbers on the inner and the outer side satisfy a condition in
/// all of the cells that the chain cuts them into, in order; without those that options.max_work
/// leaves undone.
/// @throws Error{LimitReached} beyond the limits on contacts and pieces
template <class Condition>
std::vector<std::uint32_t> faces_with(const Scene& scene, int chain,
                                      const InclusionOptions& options, const Condition& condition) {
  Allowance allowance(options.max_work);
  Arrangement arrangement(scene, {options.max_contacts, options.max_pairs}, &allowance);
  arrangement.need_own(chain);
  std::atomic<std::size_t> samples = 0;
  const auto own = [&](const Spot& spot, Side side) { return winding(scene, spot, side, chain); };
  const auto values = [&](Side side) {
    return whole_values(
        arrangement, chain, mask_of(chain), side, [&](const Spot& spot) { return own(spot, side); },
        samples, allowance);
  };
  const std::vector<int> inner = values(kInner), outer = values(kOuter);
  std::vector<char> good(inner.size(), 0);
  allowance.loop(inner.size(), [&](std::size_t i) {
    const auto f = scene.begin(chain) + static_cast<std::uint32_t>(i);
    if (scene.face(f).axis < 0) return;
    if (inner[i] != kCut && outer[i] != kCut) {
      good[i] = static_cast<char>(condition(inner[i], outer[i]));
      return;
    }
    bool all = true;
    visit_spots(arrangement, f, mask_of(chain), options.max_pieces, {}, [&](const Spot& spot) {
      all = condition(own(spot, kInner), own(spot, kOuter));
      return all;
    });
    good[i] = static_cast<char>(all);
  });
  std::vector<std::uint32_t> faces;
  for (std::uint32_t i = 0; i < good.size(); ++i) {
    if (good[i] != 0) faces.push_back(scene.begin(chain) + i);
  }
  return faces;
}

}  // namespace kaboum::verify
