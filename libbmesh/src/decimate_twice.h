#pragma once

#include <kaboum/bmesh/decimate.h>

#include "work.h"

namespace kaboum::bmesh {

/// Whether a number of vertices may be looked for within a rising error bound.
bool is_small(const geom::SolidMesh& input, const DecimateOptions& options);

/// To a number of vertices, and again to the same within less than the distance found so, if that
/// can be. @pre is_small
DecimateResult decimate_twice(const geom::SolidMesh& input, const DecimateOptions& options,
                              Work& work);

}  // namespace kaboum::bmesh
