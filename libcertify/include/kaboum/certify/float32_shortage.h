#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <optional>
#include <string>

namespace kaboum::certify {

/// Reason why float32 numbers do not do.
struct Float32Shortage {
  double spacing = 0;        ///< of float32 numbers at these coordinates [length]
  double limit = 0;          ///< on that [length]
  double of_diagonal = 0;    ///< the limit's share of the diagonal; 0: epsilon's
  double near_origin = 0;    ///< the spacing, if the middle of the box were the origin [length]
  double least_epsilon = 0;  ///< for which the spacing does here; 0: none does [length]
  /// Vertices that have no certified float32 position; 0: the spacing is larger than the limit.
  std::size_t vertices = 0;
  bool keeps_border = false;  ///< the vertices may be those of an open mesh's border
};

/// Parts of lengths that neighbouring float32 numbers may be apart.
struct SpacingShares {
  double of_diagonal, of_epsilon;
};
constexpr SpacingShares kMeshSpacing{1e-6, 1e-2};
/// Shares of convex sets with an epsilon; those without one have kMeshSpacing's (libbcd).
constexpr SpacingShares kSetSpacing{1e-4, 1e-2};

/// The shortage of float32 numbers in a box.
/// @param epsilon  none: only the diagonal counts. [length]
/// @return nullopt where the numbers are near enough to each other.
std::optional<Float32Shortage> too_coarse(const geom::Box3& box, std::optional<double> epsilon,
                                          const SpacingShares& shares = kMeshSpacing);

/// Clause that says what is wrong, with figures: begins with a small letter, ends without a full
/// stop.
std::string reason_of(const Float32Shortage& shortage);

/// Clause that says what can be done, other than numbers that are finer: "move the mesh to the
/// origin", where that helps.
std::string remedy_of(const Float32Shortage& shortage);

}  // namespace kaboum::certify
