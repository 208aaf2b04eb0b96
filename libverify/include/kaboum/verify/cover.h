#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/inclusion.h>

namespace kaboum::verify {

/// What verify_cover found.
struct Cover {
  /// Every body is a closed chain of positive volume with no vertex above any of its planes.
  Claim convex;
  /// Indices of the bodies that are not, and why, in order.
  std::vector<std::pair<std::size_t, std::string>> not_convex;
  /// The claims about the original and the union; triangles of the outer mesh are counted through
  /// the bodies one after the other.
  Inclusion inclusion;
};

/// Decides exactly whether the bodies of a set are convex and their union covers the original: its
/// solid, without voids, and every one of its triangles.
///
/// The sum of the bodies' chains winds about a point as often as there are bodies that contain it,
/// so this is verify_inclusion(original, sum). The bodies' margin counts only against the set: what
/// the bodies cover without it is verified; a point farther from all of them refutes; anything
/// between is undecided.
///
/// @throws as verify_inclusion
Cover verify_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                   const InclusionOptions& options = {});

/// The triangles of all bodies in one mesh.
geom::Mesh sum_of(const geom::ConvexSet& set);

}  // namespace kaboum::verify
