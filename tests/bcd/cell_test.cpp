#include "cell.h"

#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/mesh.h>

#include <random>

namespace kaboum::bcd {
namespace {

double volume(const Cell& cell) {
  const auto hull = geom::convex_hull(cell.corners);
  return hull ? geom::signed_volume(*hull) : 0;
}

TEST(Cell, CutsKeepTheVolume) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    Cell cell = Cell::of({Vec3(-1, -1, -1), Vec3(1, 1, 1)});
    for (int cut = 0; cut < 8; ++cut) {
      Plane plane;
      plane.n = Vec3(unit(random), unit(random), unit(random)).normalized();
      plane.d = plane.n.dot(cell.center()) + 0.05 * unit(random);
      const Cell lower = clip(cell, plane, true, 0), upper = clip(cell, plane, false, 0);
      ASSERT_NEAR(volume(lower) + volume(upper), volume(cell), 1e-9);
      // Every edge belongs to two faces: the polytope is closed.
      for (const Cell* part : {&lower, &upper}) {
        std::size_t sides = 0;
        for (std::size_t f = 0; f < part->faces.size(); ++f) sides += part->faces[f].size();
        EXPECT_EQ(sides, 2 * part->edges().size());
        EXPECT_EQ(part->corners.size() + part->faces.size(), part->edges().size() + 2);
      }
      // The overlap adds what it should.
      EXPECT_GT(volume(clip(cell, plane, true, 0.01)), volume(lower));
      cell = volume(lower) > volume(upper) ? lower : upper;
    }
  }
}

TEST(Cell, PlanesBeside) {
  const Cell cell = Cell::of({Vec3(0, 0, 0), Vec3(1, 1, 1)});
  EXPECT_EQ(clip(cell, {Vec3::UnitX(), 2}, true, 0).corners.size(), 8U);
  EXPECT_TRUE(clip(cell, {Vec3::UnitX(), 2}, false, 0).corners.empty());
}

}  // namespace
}  // namespace kaboum::bcd
