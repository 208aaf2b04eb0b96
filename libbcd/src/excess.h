#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "solid_field.h"

namespace kaboum::bcd {

/// Certified bracket of the largest distance of a body's points to the solid and its triangles.
struct Excess {
  double lower = 0, upper = 0;  ///< times the weight
  double weight = 1;            ///< of regions that the body may meet (SolidField::weight)
  Vec3 at = Vec3::Zero();       ///< a point of the body with distance ≥ lower
};

struct ExcessOptions {
  double relative_gap = 0.02;
  double absolute_gap = 0;  ///< [length]
  /// A distance known to be larger is of no interest: measuring stops, with no upper bound.
  /// [length]
  double cutoff = std::numeric_limits<double>::infinity();
  /// Of many bodies, those below this share of the largest distance sampled are not measured.
  double worth_measuring = 0.7;
  /// Parts per body that are split; beyond, the bracket is wider than the gaps.
  std::size_t max_parts = 400000;
  /// The same for the work of a body's parts, where many triangles are equally near. [ns]
  std::uint64_t work = ~std::uint64_t{0};
};

/// One bracket per body. Branch and bound over facets and, for pits and cavities that a body spans,
/// over its inside. Distances below `floor`, and below a share of the largest among all bodies or
/// of `ceiling` if that is less, are only told to be below it. All distances, those of
/// the options too, are weighted.
std::vector<Excess> measure(const std::vector<Mesh>& bodies, const SolidField& solid,
                            const ExcessOptions& options, double floor = 0,
                            double ceiling = std::numeric_limits<double>::infinity());

}  // namespace kaboum::bcd
