#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "task/layout.h"

namespace kaboum::plan {

/// Items by ascending key, for keys that are never less than the last one taken (a radix heap).
/// Items of one key come out in an order that depends on the calls alone.
class RadixQueue {
 public:
  using Key = std::uint32_t;

  /// @pre key >= the key of the last `pop`, 0 before the first.
  void push(Key key, Index item) {
    buckets_[static_cast<std::size_t>(std::bit_width(key ^ last_))].emplace_back(key, item);
    ++size_;
  }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// @pre not empty.
  std::pair<Key, Index> pop() {
    if (buckets_[0].empty()) advance();
    const auto top = buckets_[0].back();
    buckets_[0].pop_back();
    --size_;
    return top;
  }
  void clear() {
    for (auto& bucket : buckets_) bucket.clear();
    size_ = 0;
    last_ = 0;
  }

 private:
  /// The first bucket that has any is spread over those before it.
  void advance() {
    std::size_t b = 1;
    while (buckets_[b].empty()) ++b;
    last_ = std::numeric_limits<Key>::max();
    for (const auto& [key, item] : buckets_[b]) last_ = std::min(last_, key);
    for (const auto& e : buckets_[b])
      buckets_[static_cast<std::size_t>(std::bit_width(e.first ^ last_))].push_back(e);
    buckets_[b].clear();
  }

  std::array<std::vector<std::pair<Key, Index>>, 33> buckets_;
  std::size_t size_ = 0;
  Key last_ = 0;
};

}  // namespace kaboum::plan
