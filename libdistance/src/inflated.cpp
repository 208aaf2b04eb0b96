// Convex bodies enlarged by a radius, as polytopes within them. docs/algorithms/distances.md,
// "Convex sets".
#include "inflated.h"

#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/geom/body_polytopes.h>

#include <algorithm>

namespace kaboum::distance {

Inflated inflate(const geom::ConvexSet& set, int level) {
  const geom::SpherePoints sphere = geom::sphere_points(level);
  Inflated out;
  out.polytopes.bodies.resize(set.bodies.size());
  parallel_for(std::size_t{0}, set.bodies.size(), [&](std::size_t i) {
    out.polytopes.bodies[i] = {set.bodies[i].name, geom::inscribed_polytope(set.bodies[i], sphere)};
  });
  for (const geom::ConvexBody& polytope : out.polytopes.bodies)
    if (polytope.core.triangles.empty())
      throw Error(ErrorCode::InvalidInput, "body '" + polytope.name +
                                               "': its radius is too small for the digits of its "
                                               "coordinates");
  double largest = 0, radius = 0;
  for (const geom::ConvexBody& body : set.bodies) radius = std::max(radius, body.radius);
  for (const geom::ConvexBody& polytope : out.polytopes.bodies)
    for (const geom::Vec3& v : polytope.core.vertices)
      largest = std::max(largest, v.cwiseAbs().maxCoeff());
  // Sums of a coordinate and at most the radius, rounded.
  out.excess = 1e-15 * (largest + radius);
  out.defect = radius * (1 - sphere.inner) + out.excess;
  return out;
}

}  // namespace kaboum::distance
