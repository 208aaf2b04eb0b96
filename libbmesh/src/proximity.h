#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace kaboum::bmesh {

using geom::Vec3;

/// Point of the triangle (a, b, c) closest to p, in rounded arithmetic: for costs, never for
/// certificates. Source: C. Ericson, Real-Time Collision Detection (2005), 5.1.5.
Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// The square of its distance.
inline double squared_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
  return (p - closest_point(p, t[0], t[1], t[2])).squaredNorm();
}

/// Fast, uncertified distances to a fixed set of triangles.
class Proximity {
 public:
  /// Copies what it needs. @pre the mesh has triangles.
  explicit Proximity(const geom::Mesh& mesh);

  /// Squared distance of p from the set, or of any triangle that is within √enough.
  ///
  /// @param hint  a place of a triangle likely to be near (any number at first); receives the place
  ///   of the triangle found, to be the hint of the next query near by.
  double squared(const Vec3& p, std::uint32_t& hint, double enough = 0) const;

  [[nodiscard]] const std::array<Vec3, 3>& corners(std::uint32_t place) const {
    return corners_[place];
  }
  /// The triangle's index in the mesh.
  [[nodiscard]] std::uint32_t triangle(std::uint32_t place) const { return bvh_.order()[place]; }

 private:
  geom::Bvh bvh_;
  std::vector<std::array<Vec3, 3>> corners_;  // in the tree's order
};

}  // namespace kaboum::bmesh
