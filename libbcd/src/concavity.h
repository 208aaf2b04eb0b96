#pragma once

#include <kaboum/geom/convex_hull.h>

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "solid_field.h"

namespace kaboum::bcd {

/// How far a hull goes from the solid, by samples of its facets: guides the search.
struct Concavity {
  double fourth = 0;  ///< ∫ d⁴ over the facets, d the field
  double worst = 0;   ///< largest distance, times the weight
  double weight = 1;  ///< of regions that the hull may meet (SolidField::weight)
  Vec3 at = Vec3::Zero();
  double volume = 0;
  bool flat = true;  ///< no hull: the points are coplanar; the rest is that of a thin plate
};

/// Builds the hull of the points (left in `builder`) and samples it. Stops once the distance
/// exceeds `limit`, weighted; the rest is then of no use. With `perturbed` points are moved by less
/// than a billionth of their extent first: points in one plane, which the builder would have to
/// decide exactly, then cost no more than others. The builder's indices remain valid, unless the
/// result is flat.
Concavity estimate_concavity(std::span<const Vec3> points, const SolidField& solid,
                             geom::HullBuilder& builder, bool perturbed = false,
                             double limit = std::numeric_limits<double>::infinity());

/// Density of a hull's samples.
struct Density {
  double per_diagonal;  ///< samples along the hull's diagonal, at most,
  double spacings;      ///< but no nearer to each other than so many spacings of the field's grid
};
inline constexpr Density kDense{14, 1.5};
/// Enough to tell cuts apart.
inline constexpr Density kSparse{10, 3};

/// `fourth` and `volume` alone, of the points perturbed: what a cut is scored by.
/// @param limit_of  given the hull's volume: once `fourth` exceeds this, sampling stops, and the
///   true value is larger still.
Concavity estimate_fourth(std::span<const Vec3> points, const SolidField& solid,
                          geom::HullBuilder& builder,
                          const std::function<double(double volume)>& limit_of,
                          const Density& density = kDense);

/// A facet of a hull, and its share of `fourth`.
struct FacetShare {
  Triangle corners;  ///< of the points
  double fourth;
};
/// Those of the points' hull, perturbed, that have a share.
std::vector<FacetShare> facet_shares(std::span<const Vec3> points, const SolidField& solid,
                                     geom::HullBuilder& builder);

/// What estimate_concavity gives with one more of the solid's witnesses, given what it gave
/// without.
void add_witness(std::span<const Vec3> hull, const SolidField& solid,
                 const SolidField::Witness& witness, geom::HullBuilder& builder,
                 Concavity& concavity);

/// A point of a hull's facets that is farther from the solid than `limit`, looked for more densely
/// than by estimate_concavity; nothing where none is found.
/// @param builder  has built the hull of the points.
std::optional<SolidField::Witness> far_point(std::span<const Vec3> points, const SolidField& solid,
                                             const geom::HullBuilder& builder, double limit);

/// Whether a point between two extreme ones of the points (at least one) is farther from the solid
/// than `limit`: then their hull is, and need not be built.
bool spans_beyond(std::span<const Vec3> points, const SolidField& solid, double limit);

}  // namespace kaboum::bcd
