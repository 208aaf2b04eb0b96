#pragma once

#include <kaboum/bcd/cover.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace kaboum::bcd {

/// What a search can do. @throws Error{InvalidArgument} on contradictions.
void require_sound(const SearchSettings& settings, const SearchRun& run);
void require_sound(const CoverOptions& options);

/// @throws Error{InvalidArgument} where one is no triangle of the mesh
void require_doubtful(const geom::Mesh& mesh, const std::vector<std::uint32_t>& doubtful);

/// Whether float32's spacing at the mesh's coordinates exceeds a hundredth of epsilon or a
/// millionth of the diagonal.
bool too_coarse(const geom::Mesh& mesh, const std::optional<double>& epsilon);

/// max_work, or its default for an input of so many triangles. [s]
double work_allowed(const SearchSettings& settings, std::size_t triangles);

/// The least epsilon of all and of regions; nullopt where none is given. [length]
std::optional<double> finest_epsilon(const SearchRun& run);

}  // namespace kaboum::bcd
