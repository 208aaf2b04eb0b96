#pragma once

#include <kaboum/base/error.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
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

/// What the thread is at may make so many steps more, until the end of the scope.
class StepLimit {
 public:
  explicit StepLimit(std::uint64_t most) : before_(Steps::of_this_thread()) {
    Steps::of_this_thread().most = before_.done + most;
  }
  ~StepLimit() { Steps::of_this_thread().most = before_.most; }
  StepLimit(const StepLimit&) = delete;
  StepLimit& operator=(const StepLimit&) = delete;

  [[nodiscard]] std::uint64_t made() const { return Steps::of_this_thread().done - before_.done; }

 private:
  Steps before_;
};

/// An end to loops that depends on counted steps alone: the same on any machine and for any number
/// of threads.
///
/// All items have the same share of half of what is left, those that it was not enough for again
/// the same share of half of the rest, as long as that helps; then one after the other has an
/// eighth. So what is cheap is done first, and what takes most of the work has it. No loop takes
/// more than three quarters of what is left.
class Allowance {
 public:
  /// @param seconds  of one core, about; infinite: no end
  explicit Allowance(double seconds)
      : limited_(seconds < kMost),
        most_(limited_ ? static_cast<std::uint64_t>(1e9 * seconds) : 0) {}

  [[nodiscard]] bool limited() const { return limited_; }
  /// But for less than a thousandth.
  [[nodiscard]] bool spent() const { return limited_ && left() <= most_ / 1000; }
  [[nodiscard]] std::uint64_t left() const {
    if (!limited_) return std::numeric_limits<std::uint64_t>::max();
    return done_ < most_ ? most_ - done_ : 0;
  }
  void add(std::uint64_t steps) { done_ += steps; }

  /// body(i) for the items, in parallel; more than once for those that were given up.
  /// @return per item whether it was left undone; empty if none can be
  template <class Body>
  std::vector<char> loop(std::size_t count, const Body& body) {
    if (!limited_) {
      verify::parallel_for(std::size_t{0}, count, body);
      return {};
    }
    std::vector<char> undone(count, 1);
    std::vector<std::size_t> items(count);
    std::iota(items.begin(), items.end(), std::size_t{0});
    const std::uint64_t reserve = left() / 4;
    const auto try_all = [&](std::span<const std::size_t> some, std::uint64_t share) {
      std::atomic<std::uint64_t> steps = 0;
      verify::parallel_for(std::size_t{0}, some.size(), [&](std::size_t i) {
        const StepLimit limit(share);
        try {
          body(some[i]);
          undone[some[i]] = 0;
        } catch (const Error& error) {
          if (error.code() != ErrorCode::LimitReached) throw;
        }
        steps += limit.made();
      });
      done_ += steps;
    };
    for (std::size_t before = count + 1; !items.empty() && items.size() < before && !spent();) {
      before = items.size();
      try_all(items, std::max<std::uint64_t>(left() / (2 * before), 1));
      std::erase_if(items, [&](std::size_t i) { return undone[i] == 0; });
    }
    for (const std::size_t i : items) {
      if (left() <= reserve || spent()) break;
      try_all({&i, 1}, std::min(left() / 8, left() - reserve));
    }
    return undone;
  }

 private:
  static constexpr double kMost = 1e9;
  bool limited_;
  std::uint64_t most_, done_ = 0;
};

}  // namespace kaboum::verify
