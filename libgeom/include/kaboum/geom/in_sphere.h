#pragma once

#include <kaboum/geom/predicates.h>

namespace kaboum::geom {

/// Side of e with respect to the sphere through a, b, c, d: Positive inside, Zero on it, if
/// orient3d(a, b, c, d) is Positive; the opposite if that is Negative.
///
/// Exact for all finite doubles. A rounded determinant decides when it exceeds its error bound;
/// exact arithmetic (CGAL) decides the rest.
Sign in_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

}  // namespace kaboum::geom
