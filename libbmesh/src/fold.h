#pragma once

#include "quadric.h"

namespace kaboum::bmesh {

/// Triangles may turn by this much in one step: the square of the cosine of the angle between their
/// normals, 80 degrees. Of closed meshes that keeps steps from turning triangles over, which costs
/// quality and no claim; Decimate.InnerSurfacesStayInside looks at results.
constexpr double kLargestFold = 0.03;

/// Whether a triangle turns over or by too much: from a normal of the squared length given, 1 by
/// default, to one of any length; one without length is folded.
inline bool folds(const Vec3& before, const Vec3& after, double before_squared = 1) {
  const double along = after.dot(before);
  return !(along > 0) || along * along < kLargestFold * after.squaredNorm() * before_squared;
}

/// Of the spacing of numbers, what rounding moves a coordinate by: a half, and some for the
/// rounding of what it is multiplied by. Half-spaces are narrowed by it, so that the exact tests,
/// which alone decide, rarely fail.
constexpr double kHalfSpacing = 0.51;

}  // namespace kaboum::bmesh
