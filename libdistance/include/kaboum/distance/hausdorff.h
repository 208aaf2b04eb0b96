#pragma once

#include <kaboum/geom/directed_distance.h>

namespace kaboum::distance {

/// Certified brackets of the two directed distances between surfaces. [length]
struct Hausdorff {
  geom::DirectedDistance from_a, from_b;

  /// Bounds of the larger one: the Hausdorff distance lies between these.
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;
};

/// Upper bound of the distance of two meshes, as surfaces, both ways: geom::directed_distance
/// through Embree.
/// @pre indices in range; far from the origin brackets are wider (geom::directed_distance).
/// @throws Error{InvalidInput} when a mesh has no triangles or coordinates that are not finite.
Hausdorff hausdorff(const geom::Mesh& a, const geom::Mesh& b,
                    const geom::DistanceOptions& options = {});

}  // namespace kaboum::distance
