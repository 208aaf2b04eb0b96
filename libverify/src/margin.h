#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/inclusion.h>

namespace kaboum::verify {

/// Decides anew, for a set of bodies enlarged by its margin, the claims of enclosure that fail
/// without it.
///
/// Surface claim: every point of the offending triangles is within the margin of the outer solid.
/// Solid claim: so is every point of Z, the part of the inner solid that is outside the outer one.
/// Z's boundary lies on the offending triangles, so boxes are halved, from the box of these
/// triangles on, until each is within the margin, misses Z, or shows a point of Z farther away
/// (docs/algorithms/exact-inclusion.md, "Cover").
///
/// @param sum        sum_of(set)
/// @param convex     whether the bodies are, exactly: boxes are then cut along their facets, too
/// @param max_cells  boxes looked at before giving up
/// @param inclusion  verify_inclusion(inner, sum)
/// @pre geom::margin_of(set) > 0; `sum` is a closed chain
void allow_margin(const geom::Mesh& inner, const geom::Mesh& sum, const geom::ConvexSet& set,
                  bool convex, std::size_t max_cells, Inclusion& inclusion);

}  // namespace kaboum::verify
