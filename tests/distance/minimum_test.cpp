#include <kaboum/distance/minimum.h>

#include <gtest/gtest.h>

#include <random>

#include "support/families.h"
#include "support/shapes.h"

namespace {

using kaboum::distance::minimum_distance;
using kaboum::geom::Mesh;
using kaboum::geom::Vec3;

TEST(Minimum, OfBoxesApart) {
  const Mesh a = kaboum::test::box({1, 1, 1}, 3);
  for (const Vec3& gap : {Vec3(2, 0, 0), Vec3(0.25, 0.5, 0), Vec3(1e-9, 0, 0), Vec3(3, 4, 12)}) {
    Vec3 by = gap;
    for (int k = 0; k < 3; ++k)
      if (gap[k] > 0) by[k] += 1;
    const auto m = minimum_distance(a, kaboum::test::translated(a, by));
    EXPECT_LE(m.lower, gap.norm() + 1e-15);
    EXPECT_GE(m.upper, gap.norm() - 1e-15);
    EXPECT_LE(m.upper - m.lower, 1e-12);
    EXPECT_LE((m.on_a - m.on_b).norm(), m.upper);
  }
}

TEST(Minimum, IsExactlyZeroWhereSurfacesMeet) {
  const Mesh a = kaboum::test::icosphere(3);
  for (const Mesh& b :
       {a, kaboum::test::translated(a, {1, 0, 0}), kaboum::test::box({0.1, 0.1, 2}, 1)}) {
    const auto m = minimum_distance(a, b);
    EXPECT_EQ(m.lower, 0);
    EXPECT_EQ(m.upper, 0);
  }
  // Touching in one corner, along an edge, a point on a face; triangles without area.
  const Mesh box = kaboum::test::box({1, 1, 1}, 2);
  for (const Vec3& by : {Vec3(1, 1, 1), Vec3(1, 1, 0.3), Vec3(1, 0.3, 0.3)})
    EXPECT_EQ(minimum_distance(box, kaboum::test::translated(box, by)).upper, 0);
  EXPECT_EQ(minimum_distance(box, {{{1, 0.25, 0.125}}, {{0, 0, 0}}}).upper, 0);
  EXPECT_EQ(minimum_distance(box, {{{-1, 0.25, 0.125}, {2, 0.25, 0.125}}, {{0, 1, 1}}}).upper, 0);
  EXPECT_GT(minimum_distance(box, {{{1.25, 0.25, 0.125}}, {{0, 0, 0}}}).lower, 0.2499);
}

// Every sampled pair is farther apart than the lower bound, and the upper bound is attained.
// Collinear corners of which two sides are equally long within rounding: only the longer one holds
// the whole triangle, and only its far end touches the other triangle.
TEST(Minimum, IsExactlyZeroAtTheEndOfACollinearTriangle) {
  const double tiny = 0x1p-60;
  const std::array<Vec3, 3> line{Vec3(-tiny, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0)};
  const Mesh other{{{-tiny, 0, 0}, {-tiny, 1, 0}, {-tiny, 0, 1}}, {{0, 1, 2}}};
  for (std::uint32_t i = 0; i < 3; ++i)
    for (const std::uint32_t turn : {1U, 2U}) {
      const Mesh flat{{line[i], line[(i + turn) % 3], line[(i + 2 * turn) % 3]}, {{0, 1, 2}}};
      EXPECT_EQ(minimum_distance(flat, other).upper, 0) << i << turn;
      EXPECT_EQ(minimum_distance(other, flat).upper, 0) << i << turn;
    }
}

TEST(Minimum, BracketsAllPairsOfTriangles) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  for (int i = 0; i < 300; ++i) {
    Mesh a{{point(), point(), point()}, {{0, 1, 2}}};
    Mesh b{{point(), point(), point()}, {{0, 1, 2}}};
    if (i % 5 == 0) a.vertices[2] = a.vertices[0] + 0.3 * (a.vertices[1] - a.vertices[0]);
    if (i % 7 == 0)
      for (Vec3& v : b.vertices) v.z() = 0.1;
    const auto m = minimum_distance(a, b);
    EXPECT_LE(m.upper - m.lower, 1e-9) << i;
    for (int s = 0; s < 200; ++s) {
      const auto on = [&](const Mesh& t) {
        double u = 0.5 + 0.5 * unit(random), v = 0.5 + 0.5 * unit(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return Vec3(t.vertices[0] + u * (t.vertices[1] - t.vertices[0]) +
                    v * (t.vertices[2] - t.vertices[0]));
      };
      ASSERT_GE((on(a) - on(b)).norm(), m.lower - 1e-14);
    }
  }
}

}  // namespace
