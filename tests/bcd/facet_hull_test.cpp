#include "facet_hull.h"

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/facets.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/prepare.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "solids.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using geom::Vec3;

std::vector<Vec3> rounded(std::vector<Vec3> points) {
  for (Vec3& p : points) p = geom::to_float32(p);
  return points;
}

double volume_of(const geom::Mesh& hull) {
  double sum = 0;
  for (const auto& [a, b, c] : hull.triangles)
    sum += hull.vertices[a].dot(hull.vertices[b].cross(hull.vertices[c]));
  return sum / 6;
}

/// Exactly: a float32 polytope that contains the points, with few facets.
void expect_round(const geom::Mesh& body, const std::vector<Vec3>& points, std::size_t facets) {
  EXPECT_TRUE(kaboum::test::exactly_convex(body));
  for (const Vec3& p : body.vertices) EXPECT_TRUE(geom::is_float32(p));
  for (const Vec3& p : points) {
    const auto w = kaboum::test::winding_number_slow(body, p);
    EXPECT_TRUE(!w || *w == 1) << p.transpose();
  }
  EXPECT_LE(geom::float32_facet_count(body), facets);
  EXPECT_LE(body.vertices.size(), 2 * facets - 4);
}

std::vector<Vec3> ball(std::size_t count, const Vec3& size, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(
        Vec3(normal(random), normal(random), normal(random)).normalized().cwiseProduct(size));
  return rounded(out);
}

TEST(FacetCount, OfBoxesAndPrismsWhoseCornersAreRounded) {
  std::mt19937 random(5);
  for (int i = 0; i < 50; ++i) {
    std::normal_distribution<double> normal;
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized()
            .toRotationMatrix();
    std::vector<Vec3> box, prism;
    for (int c = 0; c < 8; ++c)
      box.push_back(turn * Vec3((c & 1) != 0 ? 1 : -1, (c & 2) != 0 ? 0.3 : -0.4, (c & 4) != 0));
    for (int c = 0; c < 14; ++c) {
      const double angle = 2 * std::numbers::pi * (c / 2) / 7;
      prism.push_back(turn * Vec3(std::cos(angle), std::sin(angle), c % 2));
    }
    EXPECT_EQ(geom::float32_facet_count(*geom::convex_hull(rounded(box))), 6);
    EXPECT_EQ(geom::float32_facet_count(*geom::convex_hull(rounded(prism))), 9);
  }
  const geom::Mesh tetrahedron =
      *geom::convex_hull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  EXPECT_EQ(geom::facet_count(tetrahedron, 0), 4);
}

TEST(FacetHull, HoldsItsPointsWithNoMoreFacets) {
  for (const std::size_t facets : {6U, 7U, 9U, 18U, 40U})
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
      const std::vector<Vec3> points = ball(200, Vec3(1, 0.6, 0.1 + 0.2 * seed), seed);
      expect_round(facet_hull(points, facets, 1000), points, facets);
    }
}

TEST(FacetHull, IsTheHullWhereThatHasFewFacets) {
  const std::vector<Vec3> corners =
      rounded(kaboum::test::random_hull(9, kaboum::test::Cloud::Ball, 3).vertices);
  const geom::Mesh hull = *geom::convex_hull(corners);
  EXPECT_DOUBLE_EQ(volume_of(facet_hull(corners, 40, 1000)), volume_of(hull));
}

TEST(FacetHull, OfThinFlatAndFarSets) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double thickness : {1e-3, 1e-6, 1e-7, 1e-12, 0.0})
    for (const double away : {0.0, 1000.0}) {
      std::vector<Vec3> points;
      for (int i = 0; i < 40; ++i) {
        const double x = unit(random), y = unit(random);
        points.emplace_back(away + x, y, 0.3 * x - 0.2 * y + thickness * unit(random));
      }
      points = rounded(points);
      const geom::Mesh body = facet_hull(points, 10, 16);
      expect_round(body, points, 10);
      // Not thicker than rounding makes it.
      EXPECT_LT(volume_of(body), 7 * (thickness + (away > 0 ? 1e-3 : 1e-6)));
    }
  for (const std::vector<Vec3>& points :
       {std::vector<Vec3>{{1, 2, 3}}, std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}})
    expect_round(facet_hull(points, 6, 1000), points, 6);
  EXPECT_THROW((void)facet_hull(std::vector<Vec3>{{1e39, 0, 0}}, 6, 1000), Error);
}

/// The least polytopes of 6 and 12 facets round a ball are regular.
TEST(FacetHull, OfABallIsNearlyRegular) {
  const std::vector<Vec3> points = ball(4000, Vec3(1, 1, 1), 7);
  // About the unit ball: a cube, a dodecahedron.
  const double cube = 8, dodecahedron = 10 * std::sqrt(130 - 58 * std::sqrt(5.0));
  EXPECT_LT(volume_of(facet_hull(points, 6, 1000)), 1.02 * cube);
  EXPECT_LT(volume_of(facet_hull(points, 12, 1000)), 1.02 * dodecahedron);
}

TEST(FacetHull, EachStepMakesItSmaller) {
  double removal = 0, turning = 0, exchange = 0;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    const std::vector<Vec3> points = ball(400, Vec3(1, 0.7, 0.5), seed);
    removal += volume_of(facet_hull(points, 8, 1000, PlaneSteps::Removal));
    turning += volume_of(facet_hull(points, 8, 1000, PlaneSteps::Turning));
    exchange += volume_of(facet_hull(points, 8, 1000, PlaneSteps::Exchange));
  }
  EXPECT_LT(turning, 0.98 * removal);
  EXPECT_LT(exchange, 0.995 * turning);
}

TEST(FacetHull, BodiesOfACoverKeepTheLimit) {
  const geom::Mesh mesh = kaboum::test::torus(2, 0.6, 24, 12);
  CoverOptions options = test::quick(mesh, 5);
  options.max_facets = 9;
  const CoverCandidate found = find_cover(geom::prepare(mesh).solid, options);
  ASSERT_EQ(found.stop, Stop::Done);
  for (const geom::ConvexBody& body : found.bodies) {
    EXPECT_LE(geom::float32_facet_count(body.core), 9);
    EXPECT_TRUE(kaboum::test::exactly_convex(body.core));
  }
  options.max_facets = 40;
  options.max_vertices = 10;  // 7 facets
  for (const geom::ConvexBody& body : find_cover(geom::prepare(mesh).solid, options).bodies)
    EXPECT_LE(body.core.vertices.size(), 10);
  // A limit that does not bind changes nothing.
  const geom::Mesh convex = *geom::convex_hull(
      rounded(kaboum::test::random_hull(42, kaboum::test::Cloud::Ball, 1).vertices));
  CoverOptions loose = test::quick(convex, 0.5);
  loose.max_facets = 200;
  const CoverCandidate whole = find_cover(geom::prepare(convex).solid, loose);
  ASSERT_EQ(whole.bodies.size(), 1U);
  EXPECT_EQ(whole.bodies[0].core.vertices.size(), convex.vertices.size());
  options.max_facets = 5;
  EXPECT_THROW(find_cover(geom::prepare(mesh).solid, options), Error);
  options.max_facets = 9;
  options.max_aspect = 10;
  EXPECT_THROW(find_cover(geom::prepare(mesh).solid, options), Error);
}

}  // namespace
}  // namespace kaboum::bcd
