#pragma once

#include "mesh_pair.h"
#include "pieces.h"

namespace kaboum::verify {

/// What a distance computed here errs by at most, points that come from up to 64 cuts included; in
/// the unit of the largest |coordinate|. docs/algorithms/exact-inclusion.md, "Distance".
inline double rounding_of_distances(double largest) { return 1024 * kUnit * largest + kTiny; }

/// Closest point of a triangle to p, computed in rounded arithmetic as a convex combination of the
/// corners.
Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Nearest triangle of a chain, in rounded arithmetic.
class NearestTriangle {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Hit {
    std::uint32_t face = kNone;
    double distance;
  };
  NearestTriangle(const MeshPair& meshes, int chain)
      : NearestTriangle(meshes, meshes.tree(chain)) {}
  /// Of some faces, or parts of faces, only.
  NearestTriangle(const Triangles& triangles, const BoxTree& tree)
      : triangles_(triangles), tree_(tree) {}
  /// kNone at an infinite distance when the chain has no triangle with area.
  /// @param guess  a face of the tree that may be near, which saves time; any does
  [[nodiscard]] Hit nearest(const Vec3& p, std::uint32_t guess = kNone) const;
  /// Infinite when the chain has no triangle with area.
  [[nodiscard]] double distance(const Vec3& p) const;
  /// A bound of the distance from below, but for an absolute error of a few units in the last place
  /// of the coordinates: the least over all triangles of the distance to a plane that separates p
  /// from the triangle. Boxes farther away than `within` are passed over.
  /// @param within  about the distance, from above
  [[nodiscard]] double lower_bound(const Vec3& p, double within) const;
  /// Whether lower_bound, whatever it is, exceeds `radius`.
  [[nodiscard]] bool all_beyond(const Vec3& p, double radius) const;

 private:
  /// Of the distance to one triangle, as above.
  [[nodiscard]] double lower_bound_of(const Vec3& p, std::uint32_t triangle) const;

  Triangles triangles_;
  const BoxTree& tree_;
};

}  // namespace kaboum::verify
