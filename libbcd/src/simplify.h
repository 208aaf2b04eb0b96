#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solid_field.h"

namespace kaboum::bcd {

/// Fewer vertices whose hull still contains the given hull, up to rounding.
struct Simplified {
  std::vector<Vec3> vertices;
  double cost = 0;  ///< estimate of the largest distance to the solid that was added
  /// What it was when no more than `cap` were left: no vertex is missing that need not.
  std::vector<Vec3> needed;
};

/// Contracts edges of a convex hull outwards until at most `cap` vertices are left, and beyond that
/// while a contraction costs at most `free_cost`. The cost of a new vertex is how far it and its
/// facets are from the solid (by SolidField::field) or, more cheaply, from the hull.
///
/// A new vertex lies beyond the planes through the edges round the contracted one that touch the
/// original hull, so that growth does not accumulate. When contractions get stuck above the cap the
/// hull of a prism round the points is taken instead.
Simplified simplify(std::span<const Vec3> hull, std::size_t cap, double free_cost,
                    const SolidField& solid);

}  // namespace kaboum::bcd
