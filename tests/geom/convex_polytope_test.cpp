// Polytopes by their planes, and points of triangles, against exact or slow answers.
#include <kaboum/geom/closest_point.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/convex_polytope.h>
#include <kaboum/geom/point_triangle.h>
#include <kaboum/geom/predicates.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::geom {
namespace {

struct Numbers {
  std::mt19937 random{9};
  std::uniform_real_distribution<double> unit{-1, 1};
  Vec3 point() { return {unit(random), unit(random), unit(random)}; }
};

// The sign of a height that exceeds the plane's error is the exact one.
TEST(FacetPlane, ErrsByNoMoreThanItSays) {
  Numbers draw;
  int decided = 0, slivers = 0;
  for (int round = 0; round < 20000; ++round) {
    const Vec3 a = draw.point(), b = draw.point();
    // From fair triangles to slivers.
    const Vec3 c =
        a + draw.unit(draw.random) * (b - a) + std::pow(10.0, -(round % 17)) * draw.point();
    const auto plane = facet_plane(a, b, c);
    if (!plane) {
      ++slivers;
      continue;
    }
    EXPECT_NEAR(plane->normal.norm(), 1, 1e-12);
    EXPECT_LE(plane->error, 3e-4);
    const Vec3 p = a + draw.unit(draw.random) * (b - a) + draw.unit(draw.random) * (c - a) +
                   std::pow(10.0, -(round % 13)) * draw.point();
    const double scale = 8, height = plane->height(p);
    if (std::abs(height) <= plane->error * scale + 1e-14) continue;
    ++decided;
    EXPECT_EQ(orient3d(a, b, c, p), height > 0 ? Sign::Positive : Sign::Negative);
  }
  EXPECT_GT(decided, 5000);
  EXPECT_GT(slivers, 10);
}

TEST(FacetPlane, NoneWithoutArea) {
  EXPECT_FALSE(facet_plane({0, 0, 0}, {1, 1, 1}, {2, 2, 2}).has_value());
  EXPECT_FALSE(facet_plane({0, 0, 0}, {0, 0, 0}, {1, 0, 0}).has_value());
}

TEST(ConvexPolytope, ContainsWhatTheOracleSays) {
  Numbers draw;
  for (const int n : {8, 20, 60}) {
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) points.push_back(draw.point());
    const Mesh hull = convex_hull(points).value();
    const ConvexPolytope polytope(hull);
    EXPECT_EQ(polytope.planes().size(), hull.triangles.size());
    int inside = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = 0.9 * draw.point();
      const auto w = kaboum::test::winding_number_slow(hull, p);
      EXPECT_EQ(polytope.contains(p), !w || *w == 1);
      inside += polytope.contains(p) ? 1 : 0;
      if (!polytope.contains(p)) continue;
      for (const FacetPlane& plane : polytope.planes()) EXPECT_LE(plane.height(p), 1e-12);
    }
    EXPECT_GT(inside, 5);
    for (const Vec3& v : hull.vertices)
      EXPECT_TRUE(polytope.contains(v));  // its boundary is its own
  }
}

TEST(ClosestPoint, LiesWithinTheCertifiedBracket) {
  Numbers draw;
  for (int round = 0; round < 5000; ++round) {
    const Vec3 a = draw.point(), b = draw.point(), c = draw.point(), p = 2 * draw.point();
    const DistanceBounds d = point_triangle_distance(p, a, b, c);
    const double rounded = (p - closest_point(p, a, b, c)).norm();
    EXPECT_GE(rounded, d.lower - 1e-12);
    EXPECT_LE(rounded, d.upper + 1e-9);
    EXPECT_NEAR(std::sqrt(squared_distance(p, a, b - a, c - a)), rounded, 1e-9);
  }
}

}  // namespace
}  // namespace kaboum::geom
