#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

namespace kaboum::bmesh {

/// Counts the steps of a decimation, in about nanoseconds of one core, and says when they are more
/// than allowed. Steps are counted wherever they are done; whether there are too many is asked only
/// between parallel loops, so the answer is the same for any number of threads.
class Work {
 public:
  explicit Work(double most = std::numeric_limits<double>::infinity()) : most_(most) {}
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  ~Work() = default;

  void add(std::uint64_t steps) { done_.fetch_add(steps, std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }
  /// Whether this share of what is allowed has been done.
  [[nodiscard]] bool spent(double share) const {
    return static_cast<double>(done()) >= share * most_;
  }

 private:
  double most_;
  std::atomic<std::uint64_t> done_{0};
};

/// Counts where somebody asks for it.
inline void count(Work* work, std::uint64_t steps) {
  if (work != nullptr) work->add(steps);
}

// Shares of what is allowed, after which parts of a decimation end, so that the others have time.

/// No second decimation of small meshes is begun.
constexpr double kNoneBegins = 0.3;
/// No vertex is pulled back any more, costs are not measured, and a second decimation is given up.
constexpr double kNoneMoves = 0.6;
/// No edge is contracted.
constexpr double kNoneContracts = 1;

}  // namespace kaboum::bmesh
