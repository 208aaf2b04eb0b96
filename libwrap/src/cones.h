#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <span>
#include <vector>

#include "separation.h"

namespace kaboum::wrap {

using Corners = std::array<Vec3, 3>;
using Tetrahedron = std::array<Vec3, 4>;

/// Tetrahedra with one last corner, and the planes that may part them from triangles: those along
/// their faces, made once for all triangles, and those along the triangle, or along an edge of
/// each, which together are all that need be tried. With a clearance, those across a shortest way
/// between corners, and between corners and edges, are tried as well.
class Cones {
 public:
  /// Other tetrahedra in place of those before.
  /// @pre there is at least one; their last corners are the same
  /// @param clearance  that planes have to leave; ≥ 0 [length]
  void set(std::span<const Tetrahedron> tetrahedra, double clearance);

  /// False only if certainly no point of the box is within the clearance of a tetrahedron.
  [[nodiscard]] bool may_meet(const geom::Box3& box) const;

  /// Chooses the tetrahedra that may meet the box, out of all, which are chosen at first.
  /// @return whether there are any
  bool choose(const geom::Box3& box);

  /// Whether certainly no point of the triangle is within the clearance of a chosen one.
  [[nodiscard]] bool clear_of(const Corners& triangle) const;

 private:
  struct Cone {
    geom::Box3 box;  ///< with all that is nearer than the clearance
    Corners corner;  ///< relative to the last one
    std::array<Axis, 4> faces;
  };
  struct Relative {  // a triangle, relative to the last corner
    Corners corner;
    double most;  ///< the largest |coordinate| of it and of all cones
  };

  /// Whether the axis parts its cones from what is in both boxes, of which `near` holds all that is
  /// not too far from the cones.
  [[nodiscard]] bool parts(const Axis& axis, const geom::Box3& box, const geom::Box3& near) const;
  [[nodiscard]] bool apart(const Cone& cone, const Relative& triangle) const;
  template <class Along>
  static bool apart_at_corners(const Cone& cone, const Relative& triangle, Along&& along);

  double clearance_ = 0;
  Vec3 origin_ = Vec3::Zero();
  double most_ = 0;  ///< the largest |coordinate| relative to it
  geom::Box3 all_;   ///< holds the cones' boxes
  Axis common_;      ///< of all cones
  std::vector<Cone> cones_;
  std::vector<const Cone*> chosen_;
};

}  // namespace kaboum::wrap
