#include "thicken.h"

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/width.h>

#include <random>

#include "solids.h"
#include "support/families.h"

namespace kaboum::bcd {
namespace {

/// No direction of many is narrower: does not rest on the search for the narrowest.
void expect_thick(const Mesh& hull, double thickness) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::vector<Vec3> directions;
  directions.reserve(500 + hull.triangles.size());
  for (int i = 0; i < 500; ++i)
    directions.emplace_back(normal(random), normal(random), normal(random));
  for (const Triangle& t : hull.triangles) {
    const Vec3& a = hull.vertices[t[0]];
    directions.emplace_back((hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a));
  }
  for (const Vec3& d : directions) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& p : hull.vertices) {
      low = std::min(low, d.dot(p));
      high = std::max(high, d.dot(p));
    }
    EXPECT_GE(high - low, (thickness - 1e-12) * d.norm());
  }
}

TEST(Thicken, PlatesRodsAndPointsOfAnyOrientation) {
  const Mesh ground = kaboum::test::icosphere(2);
  const SolidField solid(ground, 5000, 0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const Vec3& size : {Vec3(1, 0.8, 0.01), Vec3(1, 0.01, 0.01), Vec3(0.01, 0.01, 0.01),
                           Vec3(1, 0.8, 1e-6), Vec3(1, 0.04, 0.01), Vec3(1, 1, 1)}) {
    for (int trial = 0; trial < 4; ++trial) {
      std::vector<Vec3> points;
      points.reserve(25);
      for (int i = 0; i < 25; ++i)
        points.emplace_back(size.cwiseProduct(Vec3(unit(random), unit(random), unit(random))));
      const Mesh cloud =
          kaboum::test::to_float(kaboum::test::rotated(*geom::convex_hull(points), 1.7 * trial));
      const Mesh hull = *geom::convex_hull(cloud.vertices);
      constexpr double kThickness = 0.1;
      const Mesh thick = thicken(hull, kThickness, 32, solid);
      EXPECT_TRUE(geom::is_convex(thick));
      EXPECT_LE(thick.vertices.size(), std::max<std::size_t>(32, hull.vertices.size()));
      EXPECT_GE(geom::least_width(thick).lower, kThickness);
      expect_thick(thick, kThickness);
      for (const Vec3& p : hull.vertices) {
        const auto w = kaboum::test::winding_number_slow(thick, p);
        EXPECT_TRUE(!w || *w == 1);
      }
      // Not much thicker than asked for.
      const geom::Box3 before = geom::bounding_box(hull), after = geom::bounding_box(thick);
      EXPECT_LE((after.max - before.max).maxCoeff(), 1.5 * kThickness);
      if (size.minCoeff() == 1) {
        EXPECT_EQ(thick.vertices, hull.vertices);
      }
    }
  }
}

TEST(Thicken, DecompositionsKeepTheirClaims) {
  // Walls of 0.1: thickened where that is not enough; epsilon holds, or is said not to.
  const Mesh angle = test::prism({{0, 0}, {3, 0}, {3, 0.1}, {0.1, 0.1}, {0.1, 3}, {0, 3}}, 2);
  const geom::Prepared input = geom::prepare(angle);
  for (const double thickness : {0.05, 0.15, 0.5}) {
    CoverOptions options = test::quick(angle, 1);
    options.min_thickness = thickness;
    const CoverCandidate result = find_cover(input.solid, options);
    test::expect_cover(input.solid.mesh(), result, 64);
    for (const geom::ConvexBody& body : result.bodies) expect_thick(body.core, thickness);
    EXPECT_EQ(result.statistics.thickened, thickness > 0.1 ? result.bodies.size() : 0U);
    EXPECT_EQ(result.stop, thickness > 0.2 ? Stop::Stuck : Stop::Done);
    EXPECT_EQ(result.stop == Stop::Done, result.excess_upper <= *options.epsilon);
    EXPECT_LE(result.bodies.size(), 2U);
  }
}

TEST(Thicken, SheetsAndOptions) {
  const geom::Prepared input = geom::prepare(kaboum::test::box(Vec3(1, 1, 1e-3), 1));
  CoverOptions options = test::quick(input.solid.mesh(), 10);
  options.min_thickness = 0.1;
  const CoverCandidate result = find_cover(input.solid, options);
  ASSERT_EQ(result.bodies.size(), 1U);
  expect_thick(result.bodies[0].core, 0.1);
  EXPECT_LE(result.bodies[0].core.vertices.size(), 16U);
  options.min_thickness = -1;
  EXPECT_THROW(find_cover(input.solid, options), Error);
}

TEST(Thicken, NoBodyIsLongerThanItsWidthAllows) {
  // A sheet, a rod and an angle: some are long enough to be thickened, and epsilon is reached or is
  // said not to be. The length is that of the result, not of the input.
  const std::vector<Mesh> shapes{
      kaboum::test::box(Vec3(1, 1, 1e-3), 1), kaboum::test::box(Vec3(3, 0.01, 0.02), 1),
      test::prism({{0, 0}, {3, 0}, {3, 0.1}, {0.1, 0.1}, {0.1, 3}, {0, 3}}, 2)};
  for (const Mesh& shape : shapes)
    for (const double aspect : {4.0, 4 / (1 + 1e-12), 10.0, 100.0, 1e4}) {
      const geom::Prepared input = geom::prepare(shape);
      CoverOptions options = test::quick(input.solid.mesh(), 10);
      options.max_aspect = aspect;
      const CoverCandidate result = find_cover(input.solid, options);
      test::expect_cover(input.solid.mesh(), result, 64);
      bool thin = false;
      for (const geom::ConvexBody& body : result.bodies) {
        double longest = 0;
        for (const Vec3& p : body.core.vertices)
          for (const Vec3& q : body.core.vertices) longest = std::max(longest, (p - q).norm());
        expect_thick(body.core, longest / aspect);
        // Not much thicker than that.
        thin = thin || geom::least_width(body.core).lower < 2.5 * longest / aspect;
      }
      EXPECT_TRUE(thin || result.statistics.thickened == 0) << aspect;
      EXPECT_EQ(result.stop == Stop::Done, result.excess_upper <= *options.epsilon);
    }
  const geom::Prepared input = geom::prepare(shapes[0]);
  CoverOptions options = test::quick(input.solid.mesh(), 10);
  options.max_aspect = 3;
  EXPECT_THROW(find_cover(input.solid, options), Error);
  options.max_aspect = 10;
  options.max_total_vertices = 100;
  EXPECT_THROW(find_cover(input.solid, options), Error);
}

}  // namespace
}  // namespace kaboum::bcd
