#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>

namespace kaboum::distance {

/// Bracket of the smallest distance between two surfaces, and a pair of nearest points.
struct Minimum {
  double lower = 0;
  double upper = 0;
  geom::Vec3 on_a = geom::Vec3::Zero();  ///< |on_a − on_b| ≤ upper
  geom::Vec3 on_b = geom::Vec3::Zero();
  std::uint64_t pairs = 0;  ///< pairs of triangles that were looked at
};

/// min over x ∈ A, y ∈ B of |x − y|: dual traversal of two hierarchies, triangle pairs bracketed by
/// planes that separate them. Exactly [0, 0] when the surfaces have a point in common, which is
/// decided exactly.
/// @throws Error{InvalidInput} when a mesh has no triangles.
Minimum minimum_distance(const geom::Mesh& a, const geom::Mesh& b);

}  // namespace kaboum::distance
