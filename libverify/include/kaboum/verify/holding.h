#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/claims.h>
#include <kaboum/verify/inclusion.h>

#include <span>
#include <vector>

namespace kaboum::verify {

/// All points no farther than `radius` from the hull of the points.
struct RoundedHull {
  std::vector<geom::Vec3> points;
  double radius = 0;  ///< ≥ 0 [length]
};

/// Decides exactly whether the bodies of a set are convex and each holds the rounded hull of its
/// index: no ball about one of its points passes a plane of the body. Radii of
/// the set play no part.
///
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite.
Claim verify_holding(const geom::ConvexSet& set, std::span<const RoundedHull> held);

}  // namespace kaboum::verify
