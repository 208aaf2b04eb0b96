#pragma once

#include <kaboum/bcd/cover.h>

namespace kaboum::bcd {

/// What a search can do. @throws Error{InvalidArgument} on contradictions.
void require_sound(const SearchSettings& settings, const SearchRun& run);
void require_sound(const CoverOptions& options);

/// Whether float32's spacing at the mesh's coordinates exceeds a hundredth of epsilon or a
/// millionth of the diagonal.
bool too_coarse(const geom::Mesh& mesh, const std::optional<double>& epsilon);

/// max_work, or its default for an input of so many triangles. [s]
double work_allowed(const SearchSettings& settings, std::size_t triangles);

/// The least epsilon of all and of regions; nullopt where none is given. [length]
std::optional<double> finest_epsilon(const SearchRun& run);

}  // namespace kaboum::bcd
