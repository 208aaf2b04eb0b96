#pragma once

#include <kaboum/geom/convex_set.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kaboum::collide::detail {

/// A body as closed forms take it.
struct Shape {
  enum class Kind : std::uint8_t {
    Round,  ///< a ball or a capsule: a segment, whose ends may be one point, and a radius
    Box,    ///< a box in any direction, up to `deviation`, and a radius
    Other,  ///< what lies in the box, and a radius
  };
  Kind kind = Kind::Other;
  std::array<geom::Vec3, 2> ends{geom::Vec3::Zero(), geom::Vec3::Zero()};  ///< of a segment
  geom::Vec3 center = geom::Vec3::Zero();              ///< of the box; the segment's middle
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, orthonormal up to 2^-48
  geom::Vec3 half = geom::Vec3::Zero();                ///< of the box's edges [length]
  double deviation = 0;  ///< of the core's corners from the box's, rounded up [length]
  double radius = 0;     ///< [length]
};

/// @param body  convex
Shape shape_of(const geom::ConvexBody& body);

/// Up to eight bodies of one kind, number by number: floats nearest to what they stand for. Boxes
/// and others are one kind.
struct Lanes {
  static constexpr std::size_t kCount = 8;
  /// Rows of round bodies.
  enum Round : std::uint8_t { kFirst = 0, kSecond = 3 };
  /// Rows of boxes; axis k of the box is three rows from kAxes + 3 k on.
  enum Box : std::uint8_t { kCenter = 0, kAxes = 3, kHalf = 12, kOuter = 15, kInner = 16 };
  /// Rows of both: the radius, and what rounding errors of points are relative to.
  enum Both : std::uint8_t { kRadius = 17, kSize = 18, kRows = 19 };

  bool are_round = true;
  std::uint32_t count = 0;
  std::uint32_t body[kCount] = {};  ///< ascending; the last one repeated
  float row[kRows][kCount] = {};
  geom::Box3 box;  ///< of all of them, radii included
};

/// All bodies of a set.
struct Shapes {
  explicit Shapes(const std::vector<geom::ConvexBody>& bodies, const geom::Box3& box);

  std::vector<Shape> shape;
  /// Middle of the set's box, which `lanes` are relative to, and half its edges.
  geom::Vec3 origin = geom::Vec3::Zero(), half = geom::Vec3::Zero();
  std::vector<Lanes> lanes;
  double reach = 0;        ///< of coordinates of all bodies, radii included [length]
  bool in_floats = false;  ///< whether sizes are such that floats may be used
};

}  // namespace kaboum::collide::detail
