#pragma once

#include <kaboum/bcd/cover.h>

namespace kaboum::bcd {

/// Ways to bodies that the cuts of find_cover, which follow the shape, are compared with. Cells,
/// simplification and measuring are those of find_cover: only the bodies' shapes can be worse.
enum class ComparedMethod {
  Clusters,  ///< clusters of triangles, as HACD forms them, take the pieces of such cuts
  Voxels,    ///< cuts across the axes, as V-HACD chooses them, and merging
};

/// At most `max_bodies` bodies round a solid, unless parts that do not touch are more. The same for
/// any number of threads. No claim that they cover: verify::verify_cover decides that.
///
/// @param options  limits are max_bodies and max_vertices only.
/// @throws Error{InvalidArgument} on other limits, and as find_cover.
CoverCandidate find_cover_by(ComparedMethod method, const geom::SolidMesh& input,
                             const CoverOptions& options);

}  // namespace kaboum::bcd
