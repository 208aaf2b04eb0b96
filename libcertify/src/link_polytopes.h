#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/link_body.h>

#include <string>
#include <vector>

// Sets that hold bodies of links. Internal to kaboum_certify.
namespace kaboum::certify {

/// Polytopes that stand for bodies of a link, without a margin.
struct LinkPolytopes {
  geom::ConvexSet set;  ///< float32 vertices; its provenance is left to the caller
  double beyond = 0;    ///< bound of how far they reach beyond what the bodies stand for [length]
};

/// Each is meant to hold its body's hull and all that is within the body's margin of it. Bodies of
/// float32 points and no margin are their hulls.
///
/// @param allowance  for rounding, 1 or more
/// @pre the points are finite; those of a body without a margin that are float32 are not flat.
LinkPolytopes link_polytopes(const std::vector<robot::LinkBody>& bodies, double allowance);

/// Why the set does not hold the bodies, each in the body of its index, decided exactly by
/// libverify; empty when it does.
std::string objection(const geom::ConvexSet& set, const std::vector<robot::LinkBody>& bodies);

}  // namespace kaboum::certify
