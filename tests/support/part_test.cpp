// The example part is the solid it says it is, at every resolution.
#include "part.h"
#include "planar.h"
#include "support/oracle.h"

#include <kaboum/base/error.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace kaboum::examples {
namespace {

double volume(const geom::Mesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    six += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  }
  return six / 6;
}

TEST(Bracket, IsOneManifoldSolid) {
  for (const int resolution : {8, 9, 12, 17, 24, kBracketResolution}) {
    SCOPED_TRACE(resolution);
    const geom::Mesh mesh = make_bracket(resolution);
    EXPECT_TRUE(test::closed_manifold(mesh));
    EXPECT_EQ(test::self_intersections(mesh), 0U);
    EXPECT_NEAR(volume(mesh), 2.6e-4, 1e-6);
    // Thirteen holes: V − E + F = 2 − 2·13.
    EXPECT_EQ(
        static_cast<long>(mesh.vertices.size()) - static_cast<long>(mesh.triangles.size()) / 2,
        -24);
    EXPECT_EQ(test::winding_number_slow(mesh, {0.1, 0.06, 0.004}), 1);
    EXPECT_EQ(test::winding_number_slow(mesh, {0.05, 0.024, 0.004}), 0);  // in a bolt hole
  }
}

TEST(Bracket, DefaultSize) {
  const geom::Mesh mesh = make_bracket();
  EXPECT_GE(mesh.vertices.size(), 6000U);
  EXPECT_LE(mesh.vertices.size(), 10000U);
  EXPECT_GT(test::share_beyond_float(mesh), 0.5);
}

TEST(Bracket, RefusesOtherResolutions) {
  EXPECT_THROW(make_bracket(0), Error);
  EXPECT_THROW(make_bracket(kMaxBracketResolution + 1), Error);
}

std::int64_t doubled_area(const PlanarMesh& mesh) {
  std::int64_t sum = 0;
  for (const auto& t : mesh.triangles) {
    const GridPoint &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    const std::int64_t area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    EXPECT_GT(area, 0);
    sum += area;
  }
  return sum;
}

TEST(Planar, SquareWithHole) {
  const Loop outer{{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  const Loop hole{{40, 40}, {40, 60}, {60, 60}, {60, 40}};
  EXPECT_EQ(doubled_area(triangulate({outer}, 1000)), 20000);
  EXPECT_EQ(doubled_area(triangulate({outer, hole}, 1000)), 19200);
  EXPECT_EQ(doubled_area(triangulate({outer, hole}, 7)), 19200);
}

TEST(Planar, EnforcesEdgesThatAreNotDelaunay) {
  // A comb: long edges with foreign points close by.
  Loop comb{{0, 0}, {1000, 0}};
  for (int i = 9; i >= 0; --i) {
    comb.push_back({100 * i + 99, 1000});
    comb.push_back({100 * i + 50, 3});
  }
  const PlanarMesh mesh = triangulate({comb}, 1e6);
  EXPECT_EQ(mesh.triangles.size(), comb.size() - 2);
  std::int64_t shoelace = 0;
  for (std::size_t i = 0; i < comb.size(); ++i) {
    const GridPoint &a = comb[i], &b = comb[(i + 1) % comb.size()];
    shoelace += a.x * b.y - a.y * b.x;
  }
  EXPECT_EQ(doubled_area(mesh), shoelace);
}

TEST(Planar, RefusesCrossingLoops) {
  EXPECT_THROW(triangulate({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}}, 1000), Error);
}

}  // namespace
}  // namespace kaboum::examples
