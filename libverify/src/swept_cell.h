#pragma once

#include <kaboum/verify/sweep.h>

#include <utility>

namespace kaboum::verify {

/// A part of a shape: the hull of three points (of a mesh's surface) or four (of a solid), the
/// first of which is the shape's centre until the cell is cut flat. Points on a curved surface
/// stand for the patch of it between them: the cell's part of the shape is within `bulge` of the
/// hull.
class SweptCell {
 public:
  /// Cells that make up the shape.
  static std::vector<SweptCell> cells_of(const MovingShape& shape);

  [[nodiscard]] std::span<const geom::Vec3> points() const {
    return {points_.data(), static_cast<std::size_t>(count_)};
  }
  [[nodiscard]] double bulge() const { return bulge_; }  ///< rounded up [length]
  [[nodiscard]] double size() const;                     ///< longest edge [length]
  [[nodiscard]] double radius() const;                   ///< largest distance from the origin
  [[nodiscard]] bool curved() const { return curved_; }

  /// Halves that make up the cell's part of the shape. Along a curved edge: the bulge gets smaller.
  /// Across the longest edge: the bulge stays for good.
  [[nodiscard]] std::pair<SweptCell, SweptCell> halves(bool along_curve) const;

  std::uint32_t body = 0;  ///< one that held this cell, or what it is part of

 private:
  [[nodiscard]] double arc(int i, int k) const;  // length of the edge that counts for the bulge
  void measure();

  std::array<geom::Vec3, 4> points_{geom::Vec3::Zero(), geom::Vec3::Zero(), geom::Vec3::Zero(),
                                    geom::Vec3::Zero()};
  std::array<bool, 4> on_surface_{};
  int count_ = 3;
  bool round_ = false;   // part of a sphere, else of a cylinder
  bool curved_ = false;  // can be halved along a curve
  double shape_radius_ = 0, bulge_ = 0;
};

}  // namespace kaboum::verify
