#pragma once

#include <kaboum/geom/mesh.h>

#include <span>
#include <vector>

#include "change.h"
#include "placement.h"

namespace kaboum::bmesh {

/// The cone of triangles (apex, p, q) over a star's boundary, and for each of them what the
/// original allows: of the planes through (p, q) and points that must stay behind it, the one
/// turned farthest outwards. Linear in the apex, for the minimisation; nothing here is certified.
class SupportPlanes {
 public:
  /// @param sign  1 when the original's points must not be on the outer side, -1 when not on the
  ///   inner one.
  explicit SupportPlanes(double sign) : sign_(sign) {}

  /// Begins anew with triangles whose first corners are the apex.
  void assign(std::span<const NewTriangle> triangles);

  /// A point of the original that triangle i must not cut off.
  void keep(std::size_t i, const Vec3& point);

  /// The same for whatever of the original's triangle is inside the tetrahedron. Triangle i, or
  /// kNearest: the one nearest to each point.
  void keep(std::size_t i, const std::array<Vec3, 4>& tetrahedron,
            const std::array<Vec3, 3>& triangle);
  static constexpr std::size_t kNearest = ~std::size_t{0};

  /// Half-spaces of the apex's displacement; `spread` is how far rounding moves its coordinates.
  void half_spaces(const Vec3& spread, std::vector<HalfSpace>& out) const;

 private:
  struct Facet {
    Vec3 p, q;
    Vec3 normal;   // unit, of the triangle
    Vec3 across;   // towards the apex, in its plane
    double slope;  // of the plane that counts, against the triangle
    Vec3 through;
  };
  double sign_;
  Vec3 apex_ = Vec3::Zero();
  std::vector<Facet> facets_;
};

}  // namespace kaboum::bmesh
