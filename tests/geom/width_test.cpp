#include <gtest/gtest.h>
#include <kaboum/geom/width.h>

#include <cmath>
#include <random>

#include "support/shapes.h"

namespace kaboum::geom {
namespace {

/// In direction n, in long double.
double width_along(const Mesh& hull, const Vec3& n) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long direction = n.cast<long double>().normalized();
  long double low = std::numeric_limits<long double>::infinity(), high = -low;
  for (const Vec3& p : hull.vertices) {
    const long double h = direction.dot(p.cast<long double>());
    low = std::min(low, h);
    high = std::max(high, h);
  }
  return static_cast<double>(high - low);
}

TEST(Width, KnownOnes) {
  const Mesh box = test::box(Vec3(1, 2, 0.25), 1);
  EXPECT_LE(least_width(box).lower, 0.25);
  EXPECT_GE(least_width(box).lower, 0.25 - 1e-9);
  // Between two edges, which facets alone (0.816 of an edge) would miss.
  const Mesh tetrahedron =
      test::convex_hull({Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(1, 0, 1), Vec3(0, 1, 1)});
  EXPECT_LE(least_width(tetrahedron).lower, 1);
  EXPECT_GE(least_width(tetrahedron).lower, 1 - 1e-9);
  EXPECT_NEAR(least_width(test::translated(test::rotated(box, 1), Vec3(1e3, 0, 0))).lower, 0.25,
              1e-8);
}

TEST(Width, NoDirectionIsNarrower) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    const double flat = std::pow(10.0, -static_cast<double>(seed % 6));
    const Mesh hull = test::scaled(
        test::random_hull(40, seed % 2 == 0 ? test::Cloud::Ball : test::Cloud::Cube, seed),
        Vec3(1, 1, flat));
    const Width width = least_width(hull);
    ASSERT_GT(width.lower, 0);
    // Reached, and by no direction undercut: neither at random nor about the narrowest.
    const double reached = width_along(hull, width.direction);
    EXPECT_GE(reached, width.lower);
    EXPECT_LE(reached, width.lower + 1e-8);
    for (int i = 0; i < 1500; ++i) {
      Vec3 n(normal(random), normal(random), normal(random));
      if (i % 2 == 0) n = width.direction + flat * std::pow(10.0, -(i % 7)) * n.normalized();
      ASSERT_GE(width_along(hull, n), width.lower);
    }
  }
}

TEST(Width, Enough) {
  const Mesh ball = test::icosphere(3);
  EXPECT_EQ(least_width(ball, 1.5).lower, 1.5);
  EXPECT_LT(least_width(test::icosphere(1), 2.5).lower, 2);
}

}  // namespace
}  // namespace kaboum::geom
