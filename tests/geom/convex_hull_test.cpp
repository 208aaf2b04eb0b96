#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/convex_set.h>

#include <random>
#include <set>

#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::geom {
namespace {

/// Exactly convex, and every point of the set is on or below every facet.
void expect_hull(const std::vector<Vec3>& points) {
  const auto hull = convex_hull(points);
  ASSERT_TRUE(hull.has_value());
  EXPECT_TRUE(is_convex(*hull));
  EXPECT_TRUE(test::closed_manifold(*hull));
  EXPECT_TRUE(test::exactly_convex(*hull));
  std::set<std::array<double, 3>> input;
  for (const Vec3& p : points) input.insert({p.x(), p.y(), p.z()});
  for (const Vec3& p : hull->vertices) EXPECT_TRUE(input.contains({p.x(), p.y(), p.z()}));
  for (const Vec3& p : points) {
    const auto w = test::winding_number_slow(*hull, p);
    EXPECT_TRUE(!w || *w == 1) << p.transpose();
  }
}

TEST(ConvexHull, RandomClouds) {
  for (const int n : {4, 5, 8, 30, 200})
    for (const auto cloud : {test::Cloud::Ball, test::Cloud::Cube, test::Cloud::Sphere})
      for (std::uint32_t seed = 0; seed < 4; ++seed)
        expect_hull(test::random_hull(n, cloud, seed).vertices);
}

TEST(ConvexHull, ManyCoplanarAndCollinearPoints) {
  for (const int n : {1, 2, 3, 6}) expect_hull(test::box(Vec3(1, 2, 3), n).vertices);
  expect_hull(test::cylinder(24, 2, 3, 2).vertices);
  std::mt19937 random(3);
  std::vector<Vec3> grid;  // many ties: small integers, with repetitions and inner points
  for (int i = 0; i < 400; ++i)
    grid.emplace_back(random() % 5, random() % 5, static_cast<double>(random() % 5) * 0.1);
  expect_hull(grid);
  for (int i = 0; i < 200; ++i) grid.push_back(grid[random() % 400] + Vec3(1e-16, 0, 1e-17));
  expect_hull(grid);
}

TEST(ConvexHull, NearlyFlat) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double thickness : {1e-5, 1e-12, 1e-17}) {
    std::vector<Vec3> points;
    for (int i = 0; i < 100; ++i) {
      const double x = unit(random), y = unit(random);
      points.emplace_back(x, y, 0.3 * x + 0.7 * y + thickness * unit(random));
    }
    expect_hull(points);
  }
}

TEST(ConvexHull, FlatSetsHaveNone) {
  EXPECT_FALSE(convex_hull(std::vector<Vec3>{}).has_value());
  EXPECT_FALSE(convex_hull(std::vector<Vec3>(7, Vec3(1, 2, 3))).has_value());
  std::vector<Vec3> line, plane;
  for (int i = 0; i < 9; ++i) {
    line.emplace_back(i, 2 * i, 3 * i);
    plane.emplace_back(i % 3, i / 3, 2 * (i % 3) - i / 3);
  }
  EXPECT_FALSE(convex_hull(line).has_value());
  EXPECT_FALSE(convex_hull(plane).has_value());
  plane.emplace_back(1, 1, 1 + 1e-15);
  expect_hull(plane);
}

TEST(ConvexHull, BuilderIsReusable) {
  HullBuilder builder;
  const std::vector<Vec3> big = test::random_hull(200, test::Cloud::Ball, 1).vertices;
  const std::vector<Vec3> small = test::box(Vec3(1, 1, 1), 1).vertices;
  ASSERT_TRUE(builder.build(big));
  const Mesh first = builder.mesh();
  ASSERT_TRUE(builder.build(small));
  EXPECT_EQ(builder.vertices().size(), 8U);
  EXPECT_EQ(builder.triangles().size(), 12U);
  ASSERT_TRUE(builder.build(big));
  EXPECT_EQ(builder.mesh().triangles, first.triangles);
}

}  // namespace
}  // namespace kaboum::geom
