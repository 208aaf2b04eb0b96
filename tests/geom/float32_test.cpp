#include <kaboum/geom/float32.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using kaboum::geom::Vec3;

// GCC 12 at -O2 vectorises a pair of conversions and drops them; found because a written mesh did
// not hold the coordinates that were certified.
TEST(Float32, RoundsEveryCoordinate) {
  volatile double tenth = 0.1;
  const Vec3 p(tenth + 1e-9, 3 * tenth + 1e-9, 7 * tenth + 1e-10);
  const Vec3 q = kaboum::geom::to_float32(p);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NE(q[k], p[k]);
    EXPECT_NEAR(q[k], p[k], 6e-8);
  }
  EXPECT_TRUE(kaboum::geom::is_float32(q));
  EXPECT_FALSE(kaboum::geom::is_float32(p));
  EXPECT_FALSE(kaboum::geom::is_float32(Vec3(q.x(), p.y(), q.z())));
}

TEST(Float32, KnowsItsSpacing) {
  EXPECT_EQ(kaboum::geom::float32_spacing(1.0), std::ldexp(1.0, -23));
  EXPECT_EQ(kaboum::geom::float32_spacing(-1.5), std::ldexp(1.0, -23));
  EXPECT_EQ(kaboum::geom::float32_spacing(0.0), std::ldexp(1.0, -149));
  EXPECT_TRUE(std::isinf(kaboum::geom::float32_spacing(1e39)));
}

}  // namespace
