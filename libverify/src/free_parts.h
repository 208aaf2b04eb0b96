#pragma once

#include "region_search.h"

namespace kaboum::verify {

/// Whether what is left of the box is within the limit: without what lies beyond all of Z's
/// boundary, or of one chain, in the box, along the normals of the nearest faces, where that is
/// not in Z; the rest cut along the prisms of the triangles that distances are measured to.
bool near_without_free(const RegionSearch& search, const Bounds& box, const Vec3& p,
                       std::uint32_t face, std::size_t& work);

}  // namespace kaboum::verify
