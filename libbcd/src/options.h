#pragma once

#include <kaboum/bcd/decompose.h>

namespace kaboum::bcd {

/// @throws Error{InvalidArgument} on contradictory options.
void require_sound(const DecomposeOptions& options);

/// Whether float32's spacing at the mesh's coordinates exceeds a hundredth of epsilon or a
/// millionth of the diagonal.
bool too_coarse(const geom::Mesh& mesh, const DecomposeOptions& options);

/// max_work, or its default for an input of so many triangles. [s]
double work_allowed(const DecomposeOptions& options, std::size_t triangles);

}  // namespace kaboum::bcd
