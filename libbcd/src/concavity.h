#pragma once

#include <kaboum/geom/convex_hull.h>

#include <span>

#include "solid_field.h"

namespace kaboum::bcd {

/// How far a hull goes from the solid, by samples of its facets: guides the search.
struct Concavity {
  double fourth = 0;  ///< ∫ d⁴ over the facets, d the field
  double worst = 0;   ///< largest distance
  Vec3 at = Vec3::Zero();
  double volume = 0;
  bool flat = true;  ///< no hull: the points are coplanar; the rest is that of a thin plate
};

/// Builds the hull of the points (left in `builder`) and samples it. Stops once the distance
/// exceeds `limit`; the rest is then of no use. With `perturbed` points are moved by less than a
/// billionth of their extent first: points in one plane, which the builder would have to decide
/// exactly, then cost no more than others. The builder's indices remain valid, unless the result is
/// flat.
Concavity estimate_concavity(std::span<const Vec3> points, const SolidField& solid,
                             geom::HullBuilder& builder, bool perturbed = false,
                             double limit = std::numeric_limits<double>::infinity());

/// Whether a point between two extreme ones of the points (at least one) is farther from the solid
/// than `limit`: then their hull is, and need not be built.
bool spans_beyond(std::span<const Vec3> points, const SolidField& solid, double limit);

}  // namespace kaboum::bcd
