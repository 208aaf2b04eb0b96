#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/region.h>
#include <kaboum/verify/distance.h>
#include <kaboum/verify/inclusion.h>

namespace kaboum::verify {

/// Decides whether every point of a union of bodies that lies in a region is within the region's
/// epsilon of the original, as verify_excess does for all points. Verified, too, where no body
/// reaches the region.
///
/// Bodies that are certainly apart from the region do not count. The others are looked at as a
/// whole, then the parts of polytopes round and within them that the region holds: it is cut off by
/// planes a little outside of it, or inside of it, so that rounding does no harm
/// (docs/algorithms/exact-inclusion.md, "Regions"). Without a solid, the whole bodies alone are
/// looked at, which may leave it undecided.
///
/// @pre as verify_excess
/// @throws as verify_excess
DistanceClaim verify_region_excess(const geom::ConvexSet& set, const geom::Mesh& original,
                                   const geom::BoundedRegion& region, bool to_solid,
                                   const InclusionOptions& limits = {});

/// False: no body of the set has a point in the region, for sure.
bool may_reach(const geom::ConvexSet& set, const geom::Region& region);

}  // namespace kaboum::verify
