#pragma once

#include <vector>

#include "region_search.h"
#include "tetrahedra.h"

namespace kaboum::verify {

/// Whether all parts are within the limit of the triangles that distances are measured to, or what
/// they are cut into along the sides of the prisms over the nearest ones is. Where the corner
/// farthest from the face is not, cutting will not help.
/// @param face  a triangle that may be near to all of them
/// @param work  grows by the parts looked at
bool near_after_cuts(const RegionSearch& search, const std::vector<Part>& parts, std::uint32_t face,
                     std::size_t& work);

}  // namespace kaboum::verify
