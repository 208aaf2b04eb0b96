#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "task/numbering.h"

namespace kaboum::plan {

/// Queues of numbers by estimate that take turns: the one that was served least comes next,
/// counting boosts. Of one estimate, first come is first served.
class Queues {
 public:
  explicit Queues(std::size_t count) : queues_(count), served_(count) {}

  void push(std::size_t queue, std::uint64_t estimate, Index item) {
    queues_[queue][estimate].push_back(item);
    most_ = std::max(most_, ++size_);
  }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// @pre not empty.
  Index pop() {
    const std::size_t count = queues_.size();
    std::size_t next = count;
    for (std::size_t q = 0; q < count; ++q)
      if (!queues_[q].empty() && (next == count || served_[q] < served_[next])) next = q;
    ++served_[next];
    --size_;
    const auto best = queues_[next].begin();
    const Index item = best->second.front();
    best->second.pop_front();
    if (best->second.empty()) queues_[next].erase(best);
    return item;
  }
  /// What is in the queue comes first for a while.
  void boost(std::size_t queue) { served_[queue] -= kBoost; }
  [[nodiscard]] std::size_t bytes() const { return most_ * sizeof(Index); }

 private:
  static constexpr std::int64_t kBoost = 1000;  // turns, on progress

  std::vector<std::map<std::uint64_t, std::deque<Index>>> queues_;
  std::vector<std::int64_t> served_;
  std::size_t size_ = 0;
  std::size_t most_ = 0;
};

}  // namespace kaboum::plan
