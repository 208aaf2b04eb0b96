/// Shapes that a person would take apart in one way, and that the search has to take apart so, too.

#include <gtest/gtest.h>
#include <kaboum/bcd/cover.h>

#include <algorithm>
#include <numeric>

#include "solids.h"
#include "support/shapes.h"
#include "symmetry.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using test::lattice_solid;
using test::prism;
using test::ring;

struct Case {
  const char* name;
  Mesh mesh;
  std::size_t bodies;
  double percent = 0.5;  ///< epsilon
  double within = 1e-4;  ///< of the diagonal: how near to the very parts the bodies come
  Effort effort = Effort::Fast;
};

/// A box without lid, walls of one tenth.
Mesh open_box() {
  return lattice_solid({{{0, 0.1, 2.9, 3}, {0, 0.1, 1.9, 2}, {0, 0.1, 1}}},
                       [](int x, int y, int z) { return x != 1 || y != 1 || z == 0; });
}

/// A top on four legs, flush with its corners.
Mesh table() {
  return lattice_solid({{{0, 0.2, 2.8, 3}, {0, 0.2, 1.8, 2}, {0, 1.8, 2}}},
                       [](int x, int y, int z) { return z == 1 || (x != 1 && y != 1); });
}

/// A hub with teeth that grow narrower outwards; as many as no two can share a bar.
Mesh gear(int teeth) {
  std::vector<std::array<double, 2>> outline;
  for (int i = 0; i < teeth; ++i) {
    const double turn = 2 * std::numbers::pi / teeth;
    for (const auto& [radius, at] : {std::pair{1.0, -0.25}, {1.4, -0.15}, {1.4, 0.15}, {1.0, 0.25}})
      outline.push_back({radius * std::cos(turn * (i + at)), radius * std::sin(turn * (i + at))});
  }
  return prism(outline, 0.4);
}

/// A ring of as many prisms as it has sides.
Mesh thin_ring(int sides) {
  const auto outer = ring(sides, {1}), inner = ring(sides, {0.9});
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(sides);
  for (const double z : {0.0, 0.1})
    for (const auto* circle : {&outer, &inner})
      for (const auto& p : *circle) mesh.vertices.emplace_back(p[0], p[1], z);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    quad(i, j, 2 * n + j, 2 * n + i);                  // outside
    quad(n + j, n + i, 3 * n + i, 3 * n + j);          // inside
    quad(2 * n + i, 2 * n + j, 3 * n + j, 3 * n + i);  // above
    quad(j, i, n + i, n + j);                          // below
  }
  return mesh;
}

void expect_obvious(const Case& c) {
  SCOPED_TRACE(c.name);
  const geom::Prepared input = geom::prepare(c.mesh);
  ASSERT_TRUE(input.solid.closed());
  CoverOptions options = test::quick(c.mesh, c.percent);
  options.effort = c.effort;
  const CoverCandidate result = find_cover(input.solid, options);
  const double diagonal = geom::bounding_box(c.mesh).diagonal();
  EXPECT_EQ(result.stop, Stop::Done);
  EXPECT_LE(result.bodies.size(), c.bodies);  // epsilon may save one
  EXPECT_LE(result.excess_lower, c.within * diagonal);
  EXPECT_LE(result.excess_upper, 0.01 * c.percent * diagonal);
  test::expect_cover(input.solid.mesh(), result, 64);
}

TEST(Shapes, Letters) {
  expect_obvious({"L", prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1), 2});
  expect_obvious(
      {"U", prism({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 1), 3});
  expect_obvious(
      {"T", prism({{1, 0}, {2, 0}, {2, 2}, {3, 2}, {3, 3}, {0, 3}, {0, 2}, {1, 2}}, 1), 2});
}

TEST(Shapes, HBeam) {
  expect_obvious({"H beam",
                  prism({{0, 0},
                         {3, 0},
                         {3, 0.3},
                         {1.6, 0.3},
                         {1.6, 2.7},
                         {3, 2.7},
                         {3, 3},
                         {0, 3},
                         {0, 2.7},
                         {1.4, 2.7},
                         {1.4, 0.3},
                         {0, 0.3}},
                        6),
                  3});
}

TEST(Shapes, Table) { expect_obvious({"table", table(), 5}); }

// The number is the obvious one; epsilon is made use of.
TEST(Shapes, OpenBox) { expect_obvious({"open box", open_box(), 5, 0.05}); }
TEST(Shapes, Gear) {
  for (const int teeth : {9, 17})
    expect_obvious(
        {"gear", gear(teeth), static_cast<std::size_t>(teeth) + 1, 0.5, 0.005, Effort::Normal});
}
TEST(Shapes, BoxWithThinWalls) {
  const std::vector<double> x{0, 0.01, 0.99, 1};
  expect_obvious({"thin-walled box",
                  lattice_solid({{x, x, {0, 0.01, 1}}},
                                [](int i, int j, int k) { return i != 1 || j != 1 || k == 0; }),
                  6, 0.5, 0.005});
}

/// Planes of symmetry are found whatever the triangles are.
/// A vertex with hundreds of neighbours, as the tips of cones and the middles of discs have in CAD.
TEST(Shapes, FinelyTriangulatedCone) {
  constexpr std::uint32_t kSides = 400;
  Mesh cone;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    cone.vertices.emplace_back(std::cos(angle), std::sin(angle), 0);
    const std::uint32_t next = (i + 1) % kSides;
    cone.triangles.push_back({i, next, kSides});
    cone.triangles.push_back({next, i, kSides + 1});
  }
  cone.vertices.emplace_back(0, 0, 1.5);
  cone.vertices.emplace_back(0, 0, 0);
  const CoverOptions options = test::quick(cone, 1);
  const CoverCandidate result = find_cover(geom::prepare(cone).solid, options);
  EXPECT_EQ(result.bodies.size(), 1U);
  EXPECT_LE(result.statistics.vertices, 64U);
  EXPECT_LE(result.excess_upper, *options.epsilon);
}

/// Float32 steps that are a hundredth of epsilon leave enough to round to.
TEST(Shapes, FarFromTheOrigin) {
  const Mesh cube = kaboum::test::translated(kaboum::test::box(Vec3(1, 1, 1), 1), Vec3(500, 0, 0));
  const CoverOptions options = test::quick(cube, 5);
  const CoverCandidate result = find_cover(geom::prepare(cube).solid, options);
  EXPECT_EQ(result.stop, Stop::Done);
  EXPECT_EQ(result.bodies.size(), 1U);
  CoverOptions finer = test::quick(cube, 0.05);
  EXPECT_EQ(find_cover(geom::prepare(cube).solid, finer).stop, Stop::TooCoarse);
}

TEST(Shapes, Mirrors) {
  const auto mirrors = [](const Mesh& mesh) {
    return mirror_planes(SolidField(mesh, 1000, 0)).size();
  };
  EXPECT_EQ(mirrors(kaboum::test::box({1, 2, 3}, 2)), 3U);
  EXPECT_EQ(mirrors(gear(9)), 10U);
  EXPECT_EQ(mirrors(gear(12)), 13U);
  EXPECT_EQ(mirrors(open_box()), 2U);
  EXPECT_EQ(mirrors(prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}, 1)), 1U);
}
TEST(Shapes, Torus) {
  expect_obvious({"torus", kaboum::test::torus(1, 0.3, 12, 8), 12, 0.5, 0.005});
}
TEST(Shapes, ThinRing) { expect_obvious({"thin ring", thin_ring(12), 12, 0.5, 0.005}); }

}  // namespace
}  // namespace kaboum::bcd
