#pragma once

#include <kaboum/geom/mesh.h>

#include <optional>
#include <vector>

#include "cell.h"

namespace kaboum::bcd {

using geom::Mesh;

/// A convex body with float32 vertices, exactly convex.
struct Inscribed {
  Mesh hull;
  std::vector<Plane> planes;  ///< of the hull's triangles
  Box3 box;
  double volume = 0;
  /// Whether p is inside all planes by `slack`.
  [[nodiscard]] bool contains(const Vec3& p, double slack) const;
};

/// A large convex body that contains `seed` and whose inside no triangle meets,
/// up to rounding, with at most `most` vertices.
/// @param depth  no triangle is nearer to the seed.
/// @param rounds  fits of the ellipsoid.
/// @param safety  multiplies the distance kept from triangles for rounding's
/// sake, two float32 steps.
/// @return nullopt when the depth is below what float32 can hold.
std::optional<Inscribed> inscribe(const Mesh& boundary, const Vec3& seed, double depth,
                                  std::size_t most, int rounds, double safety = 1);

}  // namespace kaboum::bcd
