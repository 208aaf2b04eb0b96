#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/link_body.h>

#include <optional>
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

/// Polytopes within bodies of a link, without a margin.
struct InnerPolytopes {
  geom::ConvexSet set;   ///< float32 vertices; its provenance is left to the caller
  bool is_exact = true;  ///< whether they are the bodies themselves
};

/// Each is meant to lie in the hull of its body's points, farther from the planes than the margin,
/// which here is how far a point may be from where it should be: so it lies in the hull of the
/// points where they should be. Bodies of float32 points and no margin are their hulls.
///
/// @param allowance  for rounding, 1 or more
/// @return nullopt where a body is too thin for that.
std::optional<InnerPolytopes> inner_polytopes(const std::vector<robot::LinkBody>& bodies,
                                              double allowance);

/// Why the polytopes are not convex, or one does not lie in the body of its index with the margin
/// off, decided exactly by libverify; empty when they do.
std::string inner_objection(const geom::ConvexSet& set, const std::vector<robot::LinkBody>& bodies);

}  // namespace kaboum::certify
