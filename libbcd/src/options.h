#pragma once

#include <kaboum/bcd/cover.h>

namespace kaboum::bcd {

/// What both searches ask of their options. @throws Error{InvalidArgument} on contradictions.
void require_sound(const SetOptions& options);
/// The same of all of them.
void require_sound(const CoverOptions& options);

/// Whether float32's spacing at the mesh's coordinates exceeds a hundredth of epsilon or a
/// millionth of the diagonal.
bool too_coarse(const geom::Mesh& mesh, const SetOptions& options);

/// max_work, or its default for an input of so many triangles. [s]
double work_allowed(const SetOptions& options, std::size_t triangles);

}  // namespace kaboum::bcd
