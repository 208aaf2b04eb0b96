#pragma once

#include <kaboum/base/processor.h>
#include <kaboum/geom/mesh.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace kaboum::world::detail {

/// Balls at places, in floats: which of them may meet one of them.
class Balls {
 public:
  Balls() = default;
  explicit Balls(std::size_t count);

  /// A ball that holds all that is within `radius` of a place that `center` is the rounded
  /// coordinates of, up to 2^-48 of them.
  void put(std::size_t i, const geom::Vec3& center, double radius) {
    x_[i] = static_cast<float>(center.x());
    y_[i] = static_cast<float>(center.y());
    z_[i] = static_cast<float>(center.z());
    // Rounding to floats is 2^-23 of the place. The rest is for that of look_from.
    radius_[i] = static_cast<float>(
        (radius + 0x1p-22 * (std::abs(center.x()) + std::abs(center.y()) + std::abs(center.z()))) *
            (1 + 0x1p-19) +
        1e-15);
  }
  [[nodiscard]] geom::Vec3 center(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }
  [[nodiscard]] float radius(std::size_t i) const { return radius_[i]; }

  /// Words of 64 balls each: bit j % 64 of word j / 64, for j > i, is 0 only where balls i and j
  /// are apart. What other bits are is no matter. Until the next call.
  ///
  /// Differences, squares and sums of floats err by less than 2^-20 together (the parts of a sum
  /// are not negative), which the radii are larger by; what is too large for floats is not apart.
  /// @param wide  whether eight are looked at at once. @pre has_avx2() where it is
  const std::uint64_t* look_from(std::size_t i, bool wide = has_avx2());

 private:
  /// A few more than there are, so that there are eight to look at everywhere.
  std::vector<float> x_, y_, z_, radius_;
  std::vector<std::uint64_t> near_;
};

}  // namespace kaboum::world::detail
