#pragma once

#include <kaboum/base/error.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "parallel.h"

namespace kaboum::verify {

/// Steps of this thread, in about nanoseconds of one core, and how many it may make before it gives
/// up what it is at.
struct Steps {
  std::uint64_t done = 0;
  std::uint64_t most = std::numeric_limits<std::uint64_t>::max();

  static Steps& of_this_thread() {
    thread_local Steps steps;
    return steps;
  }
};

/// @throws Error{LimitReached} when what the thread is at takes too many
inline void count_steps(std::uint64_t steps) {
  Steps& mine = Steps::of_this_thread();
  mine.done += steps;
  if (mine.done > mine.most)
    throw Error(ErrorCode::LimitReached, "more work than allowed for one triangle");
}

/// An end to loops that depends on counted steps alone: the same on any machine and for any number
/// of threads. Items are taken in blocks, and none may take more than a share of what is allowed.
class Allowance {
 public:
  /// @param seconds  of one core, about; infinite: no end
  explicit Allowance(double seconds)
      : limited_(seconds < kMost),
        most_(limited_ ? static_cast<std::uint64_t>(1e9 * seconds) : 0) {}

  [[nodiscard]] bool limited() const { return limited_; }
  [[nodiscard]] bool spent() const { return limited_ && done_ >= most_; }
  [[nodiscard]] std::uint64_t left() const {
    if (!limited_) return std::numeric_limits<std::uint64_t>::max();
    return spent() ? 0 : most_ - done_;
  }
  void add(std::uint64_t steps) { done_ += steps; }

  /// body(i) for the items, in parallel. @return per item whether it was left undone; empty if none
  /// can be
  template <class Body>
  std::vector<char> loop(std::size_t count, const Body& body) {
    if (!limited_) {
      verify::parallel_for(std::size_t{0}, count, body);
      return {};
    }
    std::vector<char> undone(count, 1);
    for (std::size_t begin = 0; begin < count && !spent(); begin += kBlock) {
      const std::uint64_t share = std::max<std::uint64_t>(left() / kShares, 1);
      std::atomic<std::uint64_t> steps = 0;
      verify::parallel_for(begin, std::min(count, begin + kBlock), [&](std::size_t i) {
        Steps& mine = Steps::of_this_thread();
        const Steps before = mine;
        mine.most = mine.done + share;
        try {
          body(i);
          undone[i] = 0;
        } catch (const Error& error) {
          if (error.code() != ErrorCode::LimitReached) throw;
        }
        steps += mine.done - before.done;
        mine.most = before.most;
      });
      done_ += steps;
    }
    return undone;
  }

 private:
  static constexpr double kMost = 1e9;
  static constexpr std::size_t kBlock = 32, kShares = 64;
  bool limited_;
  std::uint64_t most_, done_ = 0;
};

}  // namespace kaboum::verify
