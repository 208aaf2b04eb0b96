// Exact cuts of polygons, and polytopes inside bodies with their margin.
#include "exact_polygon.h"

#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/triangle_search.h>

#include <random>

#include "inflated.h"
#include "support/shapes.h"

namespace kaboum::distance {
namespace {

using geom::Vec3;

exact::Number area_squared(const exact::Polygon& p) {
  exact::Point sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const exact::Point n =
        exact::cross(exact::difference(p[i], p[0]), exact::difference(p[i + 1], p[0]));
    for (std::size_t k = 0; k < 3; ++k) sum[k] += n[k];
  }
  return exact::dot(sum, sum);
}

TEST(ExactPolygon, PartsCoverTheWholeExactly) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto draw = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  int cut = 0;
  for (int round = 0; round < 300; ++round) {
    const std::array<Vec3, 3> t{draw(), draw(), draw()};
    const exact::Polygon whole{exact::point(t[0]), exact::point(t[1]), exact::point(t[2])};
    const exact::Plane plane = exact::plane_of({draw(), draw(), draw()});
    exact::Polygon below, above;
    exact::split(whole, plane, below, above);
    for (const exact::Point& p : below) EXPECT_LE(exact::height(plane, p), 0);
    for (const exact::Point& p : above) EXPECT_GE(exact::height(plane, p), 0);
    // Parts of one plane: |A| + |B| = |A + B|, as vectors along its normal.
    const exact::Number a = area_squared(below), b = area_squared(above), c = area_squared(whole);
    EXPECT_EQ((c - a - b) * (c - a - b), 4 * a * b);
    cut += below.empty() || above.empty() ? 0 : 1;
  }
  EXPECT_GT(cut, 50);
}

TEST(ExactPolygon, WhatOnlyTouchesIsNotCut) {
  const exact::Polygon t{exact::point({0, 0, 0}), exact::point({1, 0, 0}), exact::point({0, 1, 0})};
  const exact::Plane along{exact::point({0, 0, 0}), exact::point({0, 1, 0})};  // y = 0: its side
  exact::Polygon below, above;
  exact::split(t, along, below, above);
  EXPECT_TRUE(below.empty());
  EXPECT_EQ(area_squared(above), area_squared(t));
}

// Every point of the body with its margin is within `defect` of the polytope, which sticks out by
// no more than `excess`.
TEST(Inflated, IsWithinItsDefectOfTheBodyWithItsMargin) {
  geom::ConvexSet set;
  set.bodies.push_back({"box", geom::convex_hull(test::box({1, 2, 3}, 1).vertices).value()});
  set_margin(set, 0.25);
  const geom::DistanceQuery body(set.bodies[0].core);
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  double before = 1;
  for (int level = 0; level <= 2; ++level) {
    const Inflated inflated = inflate(set, level);
    EXPECT_LT(inflated.defect, before);
    before = 0.5 * inflated.defect;
    for (const Vec3& v : inflated.polytopes.bodies[0].core.vertices)
      EXPECT_LE(body.nearest(v).lower, margin_of(set).value() + inflated.excess);
    const geom::DistanceQuery polytope(inflated.polytopes.bodies[0].core);
    for (int i = 0; i < 200; ++i) {
      const Vec3 u = Vec3(normal(random), normal(random), normal(random)).normalized();
      Vec3 corner;  // farthest along u
      for (int k = 0; k < 3; ++k) corner[k] = u[k] > 0 ? k + 1 : 0;
      EXPECT_LE(polytope.nearest(corner + margin_of(set).value() * u).lower, inflated.defect);
    }
  }
}

}  // namespace
}  // namespace kaboum::distance
