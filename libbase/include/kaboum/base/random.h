#pragma once

#include <cstddef>
#include <cstdint>

namespace kaboum {

/// Numbers that are the same on every platform, which those of <random>'s distributions are not
/// (SplitMix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }
  /// In [lower, upper).
  double between(double lower, double upper) {
    return lower + (upper - lower) * (static_cast<double>(bits() >> 11U) * 0x1p-53);
  }
  /// In [0, count).
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(bits() % count); }

 private:
  std::uint64_t state_;
};

}  // namespace kaboum
