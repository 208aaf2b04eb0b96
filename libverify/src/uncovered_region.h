#pragma once

#include <kaboum/verify/inclusion.h>

#include <vector>

#include "complement_of_union.h"
#include "mesh_pair.h"
#include "pieces.h"

/// Z, the part of the inner solid that is outside the outer one: how far it reaches from something.
/// docs/algorithms/exact-inclusion.md, "Uncovered regions".
namespace kaboum::verify {

/// Work that a search takes, in parts of boxes looked at for what they are near to, about 5 μs
/// each: a minute of CPU.
constexpr std::size_t kMostWork = 20'000'000;

struct Limit {
  Triangles triangles;    ///< what the trees hold
  const BoxTree& target;  ///< triangles that distances are measured to; not empty
  const BoxTree& all;     ///< these and more: what is farther from all of them is too far
  double distance;        ///< in the meshes' unit, > 0
  std::size_t max_cells;  ///< boxes looked at before giving up
  /// The boundary of Z is known to be within the limit, so that only local maxima of the distance
  /// inside Z can exceed it. @pre what distances are measured to is made of faces of `all`
  bool inside_only;
  /// Distances are those to the outside of the inner solid: from a point of it, those to any point
  /// about which the inner chain winds less than once are as large, or larger.
  bool to_outside = false;
  /// The bodies whose sum the outer chain is, if it is that of a set.
  const ComplementOfUnion* bodies = nullptr;
  std::size_t max_work = kMostWork;
};

BoxTree tree_of(const Triangles& triangles, const std::vector<std::uint32_t>& chosen);

/// The faces that a refuted solid claim names, in order. They hold the boundary of Z, unless a
/// limit ended the search for them.
std::vector<std::uint32_t> offending_faces(const MeshPair& meshes, const Claim& claim);

/// Whether all of Z is within the limit: verified, refuted with a witness, whose depth is what it
/// is beyond the limit (the reason is left to the caller), or undecided.
///
/// @param offending  faces that Z's boundary lies on; not empty
/// @pre meshes.scaled()
Claim search_uncovered(const MeshPair& meshes, const std::vector<std::uint32_t>& offending,
                       const Limit& limit);

/// Whether every point in which the sum of bodies winds at least once is within epsilon of the
/// original's solid or triangles, given that the bodies' triangles are.
/// @param inclusion  of the sum in the original
/// @pre both are closed chains whose coordinates can be scaled
Claim excess_inside(const geom::Mesh& sum, const geom::Mesh& original, const Inclusion& inclusion,
                    double epsilon, const InclusionOptions& options);

}  // namespace kaboum::verify
