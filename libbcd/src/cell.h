#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <span>
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

/// Loops of indices, one behind the other.
class Loops {
 public:
  [[nodiscard]] std::size_t size() const { return end_.size(); }
  [[nodiscard]] bool empty() const { return end_.empty(); }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : end_[i - 1];
    return {corner_.data() + begin, end_[i] - begin};
  }
  void clear() {
    corner_.clear();
    end_.clear();
  }
  /// Adds a corner to the loop that is open: it begins where the last one ends.
  void add_corner(std::uint32_t corner) { corner_.push_back(corner); }
  /// Ends the loop, or leaves it out where it has fewer than three corners.
  void end_loop() {
    const std::size_t begin = end_.empty() ? 0 : end_.back();
    if (corner_.size() < begin + 3) {
      corner_.resize(begin);
    } else {
      end_.push_back(static_cast<std::uint32_t>(corner_.size()));
    }
  }

 private:
  std::vector<std::uint32_t> corner_, end_;
};

/// Bounded convex polytope that space is cut into: corners and faces as loops of corners.
struct Cell {
  std::vector<Vec3> corners;
  Loops faces;

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
/// The same, in the room that `out` has. @return whether anything is cut off; else `out` is as it
/// was
bool clip(const Cell& cell, const Plane& plane, bool lower, double shift, Cell& out);

}  // namespace kaboum::bcd
