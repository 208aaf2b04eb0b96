#pragma once

#include <atomic>
#include <cstdint>

namespace kaboum::bcd {

/// Counts the steps of a search, in about nanoseconds of one core, and says when they are more than
/// allowed. Steps are counted wherever they are done; whether there are too many is asked only
/// between parallel loops, so the answer is the same for any number of threads.
class Work {
 public:
  explicit Work(std::uint64_t most = ~std::uint64_t{0}) : most_(most) {}

  void add(std::uint64_t steps) { done_.fetch_add(steps, std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t most() const { return most_; }
  /// Whether this share of what is allowed has been done.
  [[nodiscard]] bool spent(double share) const {
    return static_cast<double>(done()) >= share * static_cast<double>(most_);
  }

 private:
  std::uint64_t most_;
  std::atomic<std::uint64_t> done_{0};
};

}  // namespace kaboum::bcd
