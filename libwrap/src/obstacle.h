#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/geom/triangle_search.h>

#include <span>
#include <vector>

#include "cones.h"

namespace kaboum::wrap {

/// The nearest point of the input, rounded.
struct Foot {
  Vec3 point;
  double distance;  ///< at least that from the point asked about; more by rounding only [length]
  std::uint32_t triangle;
};

/// The input's triangles, which the wrap must not pass.
class Obstacle {
 public:
  /// @pre the mesh has triangles, all finite
  /// @param clearance  that tetrahedra have to keep [length]
  explicit Obstacle(const geom::Mesh& mesh, double clearance = 0);

  /// Whether certainly no triangle meets any of the tetrahedra: closed, of either orientation,
  /// perhaps flat, with one last corner. May say no where it is hard to tell.
  [[nodiscard]] bool clear(std::span<const Tetrahedron> tetrahedra) const;

  [[nodiscard]] Foot foot(const Vec3& p, std::uint32_t hint) const {
    const auto near = query_.nearest(p, hint);
    const auto& [a, b, c] = query_.corners(near.triangle);
    return {geom::nearest_point(p, a, b, c), near.upper, near.triangle};
  }
  /// A point of the input that is not much farther than the nearest one: rounding aside,
  /// kRough times its distance is below that of every other. In the middle between many triangles
  /// that saves looking at all.
  [[nodiscard]] Foot rough_foot(const Vec3& p, std::uint32_t hint) const;
  static constexpr double kRough = 0.95;

  /// Whether some triangle is certainly within the radius; starts at `hint`, and changes it to one.
  [[nodiscard]] bool within(const Vec3& p, double radius, std::uint32_t& hint) const {
    const std::uint32_t found = query_.within(p, radius, hint);
    if (found == geom::TriangleSearch::kNone) return false;
    hint = found;
    return true;
  }

  /// Whether all points of a convex polygon are within the radius of the input, rounding aside. May
  /// say no where that takes long to tell. @param hint  a triangle
  [[nodiscard]] bool covers(std::vector<Vec3> polygon, double radius, std::uint32_t hint) const;

 private:
  geom::DistanceQuery query_;
  double clearance_;
};

}  // namespace kaboum::wrap
