#include "solid_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

TEST(SolidField, FieldIsTheSignedDistanceAndGoesOnBeyondItsGridButNotDeepInside) {
  const Mesh torus = kaboum::test::torus(1, 0.3, 40, 16);
  const SolidField solid(torus, 60000, 0);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  int inside = 0, deep = 0, beyond = 0;
  for (int i = 0; i < 2000; ++i) {
    const double size = i % 2 == 0 ? 1.3 : 4;
    const Vec3 p(size * unit(random), size * unit(random), size * unit(random));
    const double distance = solid.surface().nearest(p).upper;
    const double field = solid.field(p);
    const Vec3 outside = (solid.box().min - p).cwiseMax(p - solid.box().max).cwiseMax(0.0);
    if (solid.contains(p)) {
      EXPECT_NEAR(field, -std::min(distance, 4 * solid.spacing()), 1.5 * solid.spacing());
      deep += distance > 5.6 * solid.spacing() ? 1 : 0;
      ++inside;
    } else if (outside.norm() == 0) {
      EXPECT_NEAR(field, distance, 1.5 * solid.spacing());
    } else {
      EXPECT_GE(field, distance - 1.5 * solid.spacing());
      EXPECT_LE(field, distance + 2 * outside.norm() + 1.5 * solid.spacing());
      ++beyond;
    }
  }
  EXPECT_GE(inside, 100);
  EXPECT_GE(deep, 5);
  EXPECT_GE(beyond, 500);
}

TEST(SolidField, GridIsFineForSmallEpsilonsUpToAThirdOfWhatItsNodesGive) {
  const Mesh torus = kaboum::test::torus(1, 0.3, 40, 16);
  const double coarse = SolidField(torus, 20000, 0, false).spacing();
  EXPECT_NEAR(SolidField(torus, 20000, coarse, false).spacing(), 0.7 * coarse, 1e-9);
  EXPECT_NEAR(SolidField(torus, 20000, 0.6 * coarse, false).spacing(), 0.42 * coarse, 1e-9);
  EXPECT_NEAR(SolidField(torus, 20000, 0.1 * coarse, false).spacing(), 0.35 * coarse, 1e-9);
}

}  // namespace
}  // namespace kaboum::bcd
