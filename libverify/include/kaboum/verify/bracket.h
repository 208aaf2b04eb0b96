#pragma once

#include <kaboum/verify/inclusion.h>

#include <limits>
#include <optional>
#include <span>

namespace kaboum::verify {

/// A certified bracket of the largest distance of something.
struct Bracket {
  double lower = 0;                                        ///< reached at `at` [length]
  double upper = std::numeric_limits<double>::infinity();  ///< exceeded nowhere [length]
  geom::Vec3 at = geom::Vec3::Zero();                      ///< rounded
  std::uint32_t triangle = 0;  ///< that `at` lies on; of no meaning for solids
};

struct BracketEffort {
  std::size_t parts = 20'000;  ///< of triangles looked at besides these themselves; boxes of space
  double gap = 1e-3;           ///< ends when upper ≤ (1 + gap) lower
  /// bracket_distance ends after so much work, too; as InclusionOptions::max_work.
  double max_work = std::numeric_limits<double>::infinity();
};

/// Brackets the largest distance of the given triangles of `from` to `to` or, with `to_solid`, to
/// solid (parts of `to` that bound no solid do not count). It looks at parts of triangles, the
/// one that may be farthest first, until the bracket is narrow or the effort spent. The same for
/// any number of threads.
///
/// @pre indices within `from`; with `to_solid`, `to` is a closed chain
/// @return upper is infinite if no triangle of `to` has an area, or the coordinates span too many
///   orders of magnitude to measure distances
/// @throws Error{InvalidInput} as verify_distance
Bracket bracket_distance(const geom::Mesh& from, std::span<const std::uint32_t> triangles,
                         const geom::Mesh& to, bool to_solid, const BracketEffort& effort = {});

/// Brackets how far the inner solid reaches out of the outer one where the solid claim is refuted.
/// `lower` belongs to a point whose exact winding numbers contradict the claim, else is 0.
///
/// @param solid  the claim as verify_inclusion(inner, outer) refuted it
/// @pre both meshes are closed chains, and no limit ended the search for offending triangles
/// @throws as bracket_distance
Bracket bracket_solid(const geom::Mesh& inner, const geom::Mesh& outer, const Claim& solid,
                      const BracketEffort& effort = {});

}  // namespace kaboum::verify
