#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "body.h"

namespace kaboum::bcd {

/// What hulls round two bodies were found to be like, remembered from one merge to the next.
class PairMemo {
 public:
  using Entry = UnionEstimate;
  std::uint32_t id_of(const std::vector<int>& leaves) {
    return ids_.emplace(leaves, static_cast<std::uint32_t>(ids_.size())).first->second;
  }
  [[nodiscard]] const Entry* find(std::uint32_t a, std::uint32_t b) const {
    const auto at = pairs_.find(key(a, b));
    return at == pairs_.end() ? nullptr : &at->second;
  }
  void add(std::uint32_t a, std::uint32_t b, Entry entry) { pairs_[key(a, b)] = entry; }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
  }
  std::map<std::vector<int>, std::uint32_t> ids_;
  std::unordered_map<std::uint64_t, Entry> pairs_;
};

/// Merges neighbours, cheapest first, while the merged distance stays ≤ `epsilon` and there are
/// more than `target` bodies. The cost is that distance, and `volume_weight` times the side of a
/// cube of the volume added.
std::vector<Body> merge(std::vector<Body> bodies, const SolidField& solid, std::size_t target,
                        double epsilon, double volume_weight, PairMemo& memo);

}  // namespace kaboum::bcd
