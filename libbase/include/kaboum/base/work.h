#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

namespace kaboum {

/// Counts the steps of a search, in about nanoseconds of one core, and says when they are more than
/// allowed. Steps are counted wherever they are done, from any thread; whether there are too many
/// is asked only between parallel loops, so the answer is the same for any number of threads.
class Work {
 public:
  /// @param most  allowed. [ns]
  explicit Work(double most = std::numeric_limits<double>::infinity()) : most_(most) {}
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  ~Work() = default;

  void add(std::uint64_t steps) { done_.fetch_add(steps, std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }
  [[nodiscard]] double most() const { return most_; }
  /// True if this share of what is allowed has been done.
  [[nodiscard]] bool spent(double share) const {
    return static_cast<double>(done()) >= share * most_;
  }

 private:
  double most_;
  std::atomic<std::uint64_t> done_{0};
};

}  // namespace kaboum
