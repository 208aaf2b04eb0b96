#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <vector>

namespace kaboum::bcd {

using geom::Box3;
using geom::Vec3;

/// Oriented plane: points with n·x ≤ d are on its lower side. |n| = 1 up to rounding.
struct Plane {
  Vec3 n = Vec3::Zero();
  double d = 0;
  [[nodiscard]] double height(const Vec3& p) const { return n.dot(p) - d; }
};

/// Bounded convex polytope that space is cut into: corners and faces as loops of corners.
struct Cell {
  std::vector<Vec3> corners;
  std::vector<std::vector<std::uint32_t>> faces;

  static Cell of(const Box3& box);
  /// Corner pairs, each edge once (from < to).
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> edges() const;
  [[nodiscard]] Vec3 center() const;
  /// Every corner moved inwards, to this depth below the planes of three faces that meet there, the
  /// least alike; by 2⁻³⁰ of the way to the centre where faces are too alike for that.
  [[nodiscard]] std::vector<Vec3> inward(double depth) const;
};

struct Cube {
  Vec3 center;
  double half;
};
/// Of a cube with half side 1, half the diagonal: √3, rounded up. Bounds of what a cube holds rest
/// on it.
inline constexpr double kHalfDiagonal = 0x1.bb67ae8584cabp+0;
/// A factor that covers the rounding of a length or a radius, and of a product with it.
inline constexpr double kLengthUp = 1 + 1e-12;

/// Equal cubes that cover a box, none larger than its shortest side or, for flat ones, a sixteenth
/// of the longest.
std::vector<Cube> cubes_over(const Box3& box);

/// The part where height ≤ shift (lower) or height ≥ −shift (upper). Empty if there is none.
Cell clip(const Cell& cell, const Plane& plane, bool lower, double shift);

}  // namespace kaboum::bcd
