#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cell.h"
#include "solid_field.h"

namespace kaboum::bcd {

/// Chooses cuts across the axes by the volumes of voxels, for comparison with the planes that
/// follow the shape. Source: [mamou2016], the decomposition of V-HACD; the cuts themselves are
/// exact, as for any other plane.
class VoxelCuts {
 public:
  /// @param voxels  number asked for, of the solid's box.
  VoxelCuts(const SolidField& solid, std::size_t voxels);

  /// The plane across an axis, between voxels, for which the hulls of the voxels on either side
  /// have the least volume beyond the voxels' own, balanced ones preferred a little. Across the
  /// longest side, in the middle, where there are too few voxels.
  /// @param hull  of what is in the cell.
  /// @return nullopt when that is too small to be cut.
  [[nodiscard]] std::optional<Plane> choose(const Cell& cell, const std::vector<Vec3>& hull) const;

 private:
  using Index = std::array<int, 3>;
  /// Voxels from `low` to before `high`.
  struct Range {
    Index low, high;
  };
  struct Volumes {
    double voxels = 0, hull = 0;  ///< in voxels
  };
  [[nodiscard]] bool filled(int x, int y, int z) const {
    return filled_[static_cast<std::size_t>(x) +
                   static_cast<std::size_t>(size_[0]) *
                       (static_cast<std::size_t>(y) +
                        static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(z))] != 0;
  }
  [[nodiscard]] Volumes volumes(const Range& range) const;
  [[nodiscard]] double cost(const Range& range, int axis, int at) const;

  Vec3 origin_;
  double spacing_ = 0, smallest_ = 0;
  Index size_{};
  std::vector<char> filled_;
};

}  // namespace kaboum::bcd
