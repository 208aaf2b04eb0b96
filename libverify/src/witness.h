#pragma once

#include <kaboum/verify/inclusion.h>

#include <vector>

#include "arrangement.h"

namespace kaboum::verify {

/// A place where a claim was found false.
struct Offence {
  std::uint32_t face;
  Side side;   ///< of the face, on which the offending region lies
  Vec3 point;  ///< of the face, rounded
};

/// A point with double coordinates in an offending region, deep if possible.
///
/// Corners and samples of the offending faces are tried in order of their distance from the outer
/// mesh, moved off the surfaces; the first whose exact winding numbers contradict the claim is
/// taken.
///
/// @param on_surface  the surface claim: the point need only be outside the outer solid
/// @param relative    the relative claim: w_inner > w_outer
Witness find_witness(const MeshPair& meshes, const std::vector<Offence>& offences, bool on_surface,
                     bool relative);

}  // namespace kaboum::verify
