#pragma once

#include <optional>

#include "mesh_pair.h"
#include "number.h"

/// Points and segments in the closure of {w ≥ 1} of a closed chain; exact.
/// docs/algorithms/exact-inclusion.md, "Segments and points".
namespace kaboum::verify {

/// The point x / w.
struct ExactPoint {
  Triple<Exact> x;
  Exact w;     ///< above 0
  Bounds box;  ///< holds the point
};

/// Whether a point is in closure{w ≥ 1} of a closed chain.
/// @throws Error{LimitReached} after count_steps's limit, or where too many planes meet in it
bool is_in_solid(const MeshPair& meshes, int chain, const ExactPoint& point);

/// A point of the segment from p to q, which may be one point, that is not in closure{w ≥ 1} of a
/// closed chain, rounded; nullopt if there is none.
/// @throws Error{LimitReached} as is_in_solid
std::optional<Vec3> segment_outside(const MeshPair& meshes, int chain, const Vec3& p,
                                    const Vec3& q);

}  // namespace kaboum::verify
