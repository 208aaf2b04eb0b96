#pragma once

#include <kaboum/geom/mesh.h>

#include <limits>
#include <vector>

namespace kaboum::geom {

/// Width of a convex body.
struct Width {
  double lower = 0;  ///< certified: the body is at least this wide in every direction [length]
  /// Unit vector in which it is about that wide; zero where the search ended at `enough`.
  Vec3 direction = Vec3::Zero();
};

/// The least width of a convex body: the smallest distance of two parallel planes with the body
/// between them. The bound falls short of it by less than a billionth of the body's size.
///
/// The width in direction n is the support function of the difference body K − K, whose facets have
/// a normal of a facet of K or one across two edges of K. The smallest distance of such a facet
/// from the centre is the least width. All are tried, in double precision with bounds of the
/// rounding errors; normals of nearly parallel edges in exact arithmetic.
///
/// @param enough  whether the body is wider than this is of no interest: `lower` is then `enough`.
/// @pre exactly convex (is_convex); coordinates of magnitude below 1e60. Cost up to
/// O(#T² · #V); for most bodies O(#T²).
Width least_width(const Mesh& hull, double enough = std::numeric_limits<double>::infinity());

/// Upper bound of the largest distance of two of the points, within rounding of it for up to a few
/// thousand points; of more the diagonal of their box.
double longest_upper(const std::vector<Vec3>& points);

}  // namespace kaboum::geom
