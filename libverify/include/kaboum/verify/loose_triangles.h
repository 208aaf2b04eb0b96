#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <vector>

namespace kaboum::verify {

/// Triangles of a closed mesh that are not known to lie in its solid, ascending.
///
/// Every triangle that is not among them lies in closure{w ≥ 1}, exactly: w ≥ 1 on its inner side.
/// Those of folds, of parts that are inside out and of sheets are among them, and so are all that
/// others cut or lie along: verify_inclusion decides these. docs/algorithms/exact-inclusion.md,
/// "Loose triangles".
///
/// The result does not depend on the number of threads.
///
/// @param mesh  with a closed chain of edges by its indices, else all of its triangles are loose;
///   coordinates and extents between 1e-60 and 1e60
/// @throws Error{InvalidInput} as geom::require_valid
std::vector<std::uint32_t> find_loose_triangles(const geom::Mesh& mesh);

}  // namespace kaboum::verify
