#include <kaboum/base/error.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/prepare.h>

#include <gtest/gtest.h>

#include "support/families.h"

namespace {

TEST(IsConvex, AgreesWithTheFamilies) {
  int convex = 0;
  for (const auto& f : kaboum::test::closed_families()) {
    if (f.mesh.triangles.size() > 4000) continue;
    if (!f.solid || f.name == "cubes-sharing-face") continue;  // convex once the wall is cancelled
    try {
      EXPECT_EQ(kaboum::geom::is_convex(kaboum::geom::prepare(f.mesh).solid.mesh()), f.convex)
          << f.name;
      convex += f.convex;
    } catch (const kaboum::Error&) {
      EXPECT_FALSE(f.convex) << f.name;  // sheets
    }
  }
  EXPECT_GE(convex, 3);
}

TEST(IsConvex, SeesTheLastBit) {
  kaboum::geom::Mesh pyramid{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}},
                             {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  EXPECT_TRUE(kaboum::geom::is_convex(pyramid));
  // The base's diagonal is raised by the smallest number: the base becomes concave.
  pyramid.vertices[0].z() = pyramid.vertices[2].z() = 5e-324;
  EXPECT_FALSE(kaboum::geom::is_convex(pyramid));
  pyramid.vertices[0].z() = pyramid.vertices[2].z() = -5e-324;
  EXPECT_TRUE(kaboum::geom::is_convex(pyramid));
}

}  // namespace
