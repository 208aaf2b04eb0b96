#pragma once

#include <kaboum/geom/prepare.h>

namespace kaboum::tools {

/// A mesh as bmesh-decimate and bcd-decompose prepare it: what they claim is about that.
/// @param fill  fill its holes, as both do by default.
/// @throws Error{InvalidInput} as geom::prepare.
geom::Prepared prepare_original(const geom::Mesh& mesh, bool drop_sheets, bool fill);

}  // namespace kaboum::tools
