#include "piece.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

/// The part of a piece on one side.
Piece part(const Piece& piece, const Plane& plane, bool lower, const SolidField& solid,
           double shift) {
  std::vector<double> height;
  std::vector<Side> side;
  classify(piece, plane, solid, shift, height, side);
  return clip(piece, plane, lower, shift, solid, height, side);
}

/// Cells reach across a cut along a face, by their overlap, into the solid there; a body must not
/// contain their corners: it would span whatever is between them and its part of the solid.
TEST(Piece, NothingOfTheSolidIsBeyondItsFaceHoweverThinTheCell) {
  const Mesh box = kaboum::test::box({10, 10, 2}, 3);
  const SolidField solid(box, 1000, 0);
  const double top = solid.box().max.z(), shift = 0x1p-36 * 10;
  const Vec3 middle = solid.box().center();
  for (const double thickness : {1.0, 1e-3, 1e-6, 1e-8}) {
    SCOPED_TRACE(thickness);
    Piece piece = part(whole(solid), {Vec3::UnitZ(), top}, false, solid, shift);
    piece = part(piece, {Vec3::UnitZ(), top + thickness}, true, solid, shift);
    piece = part(piece, {Vec3::UnitX(), middle.x()}, true, solid, shift);
    piece = part(piece, {Vec3::UnitY(), middle.y()}, true, solid, shift);
    EXPECT_TRUE(piece.empty());
  }
}

/// But corners in the solid are never lost, neither in thin walls nor in thin cells.
TEST(Piece, ThinCellsThroughWallsHaveTheirCorners) {
  for (const double wall : {1e-3, 0.05, 2.0})
    for (const double thickness : {1e-3, 1e-5, 1e-7})
      for (const double safety : {1.0, 64.0, 4096.0}) {
        const double shift = safety * 0x1p-36 * 10;
        if (wall < 32 * shift || thickness < 32 * shift) continue;
        SCOPED_TRACE(testing::Message() << wall << ' ' << thickness << ' ' << safety);
        const Mesh box = kaboum::test::box({wall, 10, 10}, 3);
        const SolidField solid(box, 1000, 0);
        const Vec3 middle = solid.box().center();
        // Along the wall's middle, across it twice: one edge of the cell is in the wall.
        Piece piece = part(whole(solid), {Vec3::UnitX(), middle.x()}, false, solid, shift);
        for (const Vec3& n : {Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
          const double size = n.z() > 0 ? thickness : 5;
          piece = part(piece, {n, n.dot(middle) - 0.5 * size}, false, solid, shift);
          piece = part(piece, {n, n.dot(middle) + 0.5 * size}, true, solid, shift);
        }
        EXPECT_EQ(std::count(piece.inside.begin(), piece.inside.end(), 1), 4);
      }
}

}  // namespace
}  // namespace kaboum::bcd
