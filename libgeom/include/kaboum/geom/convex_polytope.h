#pragma once

#include <kaboum/geom/mesh.h>

#include <optional>
#include <span>
#include <vector>

namespace kaboum::geom {

/// The plane of a facet: points below it have normal · x ≤ offset.
struct FacetPlane {
  Vec3 normal;    ///< outwards; unit, up to rounding
  double offset;  ///< [length]
  /// Rounding of the plane itself: it moves no point whose coordinates and whose distance from the
  /// facet are below s by more than error · s. 3e-4 at most.
  double error;

  [[nodiscard]] double height(const Vec3& p) const { return normal.dot(p) - offset; }
};

/// The plane through three points, counter-clockwise seen from above; nullopt where rounding leaves
/// its normal open, as slivers do. Those that double leaves open are computed in long double.
std::optional<FacetPlane> facet_plane(const Vec3& a, const Vec3& b, const Vec3& c);

/// A convex polytope by its vertices and facets, and by the planes of these.
class ConvexPolytope {
 public:
  /// @pre exactly convex (is_convex), as HullBuilder makes it: that is not looked at again.
  explicit ConvexPolytope(Mesh hull);

  [[nodiscard]] const Mesh& hull() const { return hull_; }
  [[nodiscard]] const Box3& box() const { return box_; }
  /// Planes of the facets that have one (facet_plane): the polytope lies below all of them, and
  /// points that are below them need not lie in it.
  [[nodiscard]] std::span<const FacetPlane> planes() const { return planes_; }
  /// True if the point is in the polytope or on its boundary; exact.
  [[nodiscard]] bool contains(const Vec3& p) const;

 private:
  Mesh hull_;
  Box3 box_;
  std::vector<FacetPlane> planes_;
};

}  // namespace kaboum::geom
