#pragma once

#include <kaboum/base/processor.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kaboum::collide::detail {

constexpr std::size_t kFloatsAtOnce = 8;

/// A point, and its product with a direction.
struct Farthest {
  std::uint32_t index = 0;
  float product = 0;
};

struct FarthestPair {
  Farthest a, b;
};

/// Points of two bodies, each farthest along a direction by products in floats, (dx · x + dy · y) +
/// dz · z. Which of several equal products is found depends on how many are looked at at once.
/// @param a, b  eight x, eight y, eight z, and so on; not empty. @param along_a  of a; along_b of b
/// @param wide  whether eight are looked at at once, else four. @pre has_avx2() where it is
FarthestPair farthest_of(std::span<const float> a, const std::array<float, 3>& along_a,
                         std::span<const float> b, const std::array<float, 3>& along_b,
                         bool wide = has_avx2());

}  // namespace kaboum::collide::detail
