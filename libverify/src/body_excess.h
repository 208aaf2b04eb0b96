#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/region.h>
#include <kaboum/verify/distance.h>

#include <cstddef>
#include <vector>

namespace kaboum::verify {

/// True if each body is a convex polytope without a radius, a ball, a capsule, or nearly a box,
/// rounded by its radius or not: boxes that hold them reach no farther beyond them than rounding of
/// their coordinates to float32.
bool have_cells(const geom::ConvexSet& set);

/// Decides whether every point of a union of rounded boxes, or of what a region holds of it, is
/// within `epsilon` of a solid or its triangles. The bodies are cut into cells until each is
/// decided (docs/algorithms/rounded-bodies.md, "Cells of rounded boxes").
///
/// Undecided where the farthest point is as far as epsilon but for rounding or the digits of the
/// boxes' corners, or where it takes more cells than are allowed.
///
/// @param region  nullptr: all of space
/// @param region_rounding  what is no farther than that from the region's border counts as outside
///   where it would refute, as inside where it would verify [length]
/// @param open  gets the bodies that are not decided, unless the claim is refuted; else what is
/// said
///   ends at the first ones
/// @pre have_cells(set); epsilon > 0; the original is a closed chain with a triangle of some
///   area
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite.
DistanceClaim verify_body_excess(const geom::ConvexSet& set, const geom::Mesh& original,
                                 double epsilon, const geom::Region* region = nullptr,
                                 double region_rounding = 0,
                                 std::vector<std::size_t>* open = nullptr);

}  // namespace kaboum::verify
