#pragma once

#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/winding.h>

#include <cstdint>

#include "boundary.h"

namespace kaboum::bcd {

/// Bounds of depths in a solid: distances to its complement.
class DepthBounds {
 public:
  /// Keeps a reference to the winding numbers.
  DepthBounds(const Mesh& mesh, const geom::WindingNumber& winding, const Boundary& boundary);

  /// Winding number ≥ 1, or on a triangle; exact.
  [[nodiscard]] bool inside(const Vec3& p) const;
  /// The nearest part of the boundary: of a point inside, `lower` bounds the depth from below.
  [[nodiscard]] geom::TriangleSearch::Nearest nearest(
      const Vec3& p, std::uint32_t hint = geom::TriangleSearch::kNone) const {
    return query_.nearest(p, hint);
  }
  [[nodiscard]] Vec3 nearest_point(const Vec3& p, std::uint32_t triangle) const;
  /// Bound of a point's depth from above: its distance to a point that is certainly outside.
  /// @param triangle  the nearest one
  [[nodiscard]] double upper(const Vec3& p, std::uint32_t triangle) const;

  [[nodiscard]] double diagonal() const { return diagonal_; }
  /// Most error of a distance by rounding. [length]
  [[nodiscard]] double slack() const { return slack_; }

 private:
  const geom::WindingNumber& winding_;
  geom::DistanceQuery query_;
  geom::DistanceQuery outside_;  // points that are
  double diagonal_ = 0, slack_ = 0;
};

}  // namespace kaboum::bcd
