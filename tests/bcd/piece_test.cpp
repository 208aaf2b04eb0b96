#include "piece.h"

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

/// The part of a piece on one side.
Piece part(const Piece& piece, const Plane& plane, bool lower, const Solid& solid, double shift) {
  std::vector<double> height;
  std::vector<Side> side;
  classify(piece, plane, solid, shift, height, side);
  return clip(piece, plane, lower, shift, solid, height, side);
}

/// Cells reach across a cut along a face, by their overlap, into the solid there; a body must not
/// contain their corners: it would span whatever is between them and its part of the solid.
TEST(Piece, NothingOfTheSolidIsBeyondItsFaceHoweverThinTheCell) {
  const Mesh box = test::box({10, 10, 2}, 3);
  const Solid solid(box, 1000, 0);
  const double top = solid.box().max.z(), shift = 0x1p-36 * 10;
  const Vec3 middle = solid.box().center();
  for (const double thickness : {1.0, 1e-3, 1e-6}) {
    SCOPED_TRACE(thickness);
    Piece piece = part(whole(solid), {Vec3::UnitZ(), top}, false, solid, shift);
    piece = part(piece, {Vec3::UnitZ(), top + thickness}, true, solid, shift);
    piece = part(piece, {Vec3::UnitX(), middle.x()}, true, solid, shift);
    piece = part(piece, {Vec3::UnitY(), middle.y()}, true, solid, shift);
    EXPECT_TRUE(piece.empty());
  }
}

/// But corners in the solid are never lost.
TEST(Piece, ThinCellsInTheSolidHaveAllTheirCorners) {
  const Mesh box = test::box({10, 10, 2}, 3);
  const Solid solid(box, 1000, 0);
  const double shift = 0x1p-36 * 10;
  const Vec3 middle = solid.box().center();
  for (const double thickness : {0.5, 1e-3, 1e-6}) {
    SCOPED_TRACE(thickness);
    Piece piece = whole(solid);
    for (const Vec3& n : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
      const double size = n.z() > 0 ? thickness : 1;
      piece = part(piece, {n, n.dot(middle) - 0.5 * size}, false, solid, shift);
      piece = part(piece, {n, n.dot(middle) + 0.5 * size}, true, solid, shift);
    }
    EXPECT_EQ(piece.hull_points().size(), 8U);
  }
}

}  // namespace
}  // namespace kaboum::bcd
