#pragma once

#include <kaboum/geom/triangle_search.h>

#include <memory>

namespace kaboum::distance {

/// Search structure for nearest triangles. Both answer with brackets of the same meaning; they may
/// name different triangles where several are equally near within rounding.
enum class Backend {
  Embree,  ///< Embree's float32 hierarchy culls, double decides
  Own      ///< geom::DistanceQuery
};

/// A search structure over the mesh's triangles.
///
/// Embree: triangles are user primitives whose float32 boxes are rounded outwards in coordinates
/// that are shifted to the mesh's centre and scaled to unit size. Each query's radius is enlarged
/// by what the float32 query point and the traversal may err, so that no triangle nearer than the
/// best one found is culled (docs/algorithms/distances.md). Building uses all of oneTBB's threads;
/// the answers do not depend on their number.
///
/// @throws Error{InvalidInput} if the mesh has no triangles; Error{LimitReached} if Embree runs out
///   of memory.
/// @pre indices in range, coordinates finite and of magnitude below 1e60.
std::unique_ptr<geom::TriangleSearch> make_search(const geom::Mesh& mesh, Backend backend);

}  // namespace kaboum::distance
