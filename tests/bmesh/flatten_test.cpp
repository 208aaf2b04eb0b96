// Coplanar regions lose the vertices that they do not need, and nothing else.

#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/verify/replay.h>

#include <gtest/gtest.h>

#include <set>

#include "recorded.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT
using verify::replay;
using verify::ReplayResult;

/// A square plate with n × n square holes, all faces grids of unit squares; closed.
geom::Mesh plate(int n) {
  const int size = 3 * n + 2;
  const auto full = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= size || y >= size) return false;
    return x % 3 != 2 || y % 3 != 2 || x == size - 1 || y == size - 1;
  };
  geom::Mesh m;
  const auto quad = [&](const geom::Vec3& a, const geom::Vec3& b, const geom::Vec3& c,
                        const geom::Vec3& d) {
    const auto first = static_cast<std::uint32_t>(m.vertices.size());
    m.vertices.insert(m.vertices.end(), {a, b, c, d});
    m.triangles.push_back({first, first + 1, first + 2});
    m.triangles.push_back({first, first + 2, first + 3});
  };
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      if (!full(i, j)) continue;
      const double x = i, y = j;
      quad({x, y, 1}, {x + 1, y, 1}, {x + 1, y + 1, 1}, {x, y + 1, 1});
      quad({x, y, 0}, {x, y + 1, 0}, {x + 1, y + 1, 0}, {x + 1, y, 0});
      if (!full(i - 1, j)) quad({x, y, 0}, {x, y, 1}, {x, y + 1, 1}, {x, y + 1, 0});
      if (!full(i + 1, j)) quad({x + 1, y, 0}, {x + 1, y + 1, 0}, {x + 1, y + 1, 1}, {x + 1, y, 1});
      if (!full(i, j - 1)) quad({x, y, 0}, {x + 1, y, 0}, {x + 1, y, 1}, {x, y, 1});
      if (!full(i, j + 1)) quad({x, y + 1, 0}, {x, y + 1, 1}, {x + 1, y + 1, 1}, {x + 1, y + 1, 0});
    }
  }
  return m;
}

/// Exactly the same solid, and all corners are corners of the input.
void expect_same(const geom::Mesh& input, const geom::Mesh& result) {
  for (const auto& [a, b] : {std::pair{&input, &result}, {&result, &input}}) {
    const verify::Inclusion i = verify::verify_inclusion(*a, *b);
    EXPECT_EQ(i.solid.answer, verify::Answer::Verified);
    EXPECT_EQ(i.surface.answer, verify::Answer::Verified);
  }
  const auto key = [](const geom::Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  std::set<std::array<double, 3>> corners;
  for (const geom::Vec3& p : input.vertices) corners.insert(key(p));
  for (const geom::Vec3& p : result.vertices) EXPECT_TRUE(corners.contains(key(p)));
}

DecimateResult run(const geom::Mesh& mesh, const DecimateOptions& o) {
  test::Recorded r = test::record(mesh, o);
  const ReplayResult checked = replay(mesh, r.log, r.result.mesh);
  EXPECT_TRUE(checked.verified) << checked.violation;
  return std::move(r.result);
}

std::vector<DecimateOptions> methods(std::size_t vertices) {
  std::vector<DecimateOptions> out;
  for (const Direction d : {Direction::Outer, Direction::Inner, Direction::Any})
    for (const auto& [cost, effort] : {std::pair{Cost::Planes, Effort::Fast},
                                       {Cost::Triangles, Effort::Fast},
                                       {Cost::Distance, Effort::Normal}}) {
      DecimateOptions o;
      o.direction = d;
      o.cost = cost;
      o.effort = effort;
      o.vertices = vertices;
      out.push_back(o);
    }
  return out;
}

TEST(Flat, ASubdividedCubeNeedsItsEightCorners) {
  const geom::Mesh cube = test::box({3, 5, 2}, 12);
  for (const DecimateOptions& o : methods(8)) {
    const DecimateResult r = run(cube, o);
    EXPECT_EQ(r.stop, Stop::VertexTarget);
    EXPECT_EQ(r.mesh.vertices.size(), 8U);
    expect_same(cube, r.mesh);
  }
}

TEST(Flat, APlateWithHolesKeepsItsPolygonsCorners) {
  for (const int n : {1, 3}) {
    const geom::Mesh mesh = plate(n);
    const auto corners = static_cast<std::size_t>(8 + 8 * n * n);
    for (const DecimateOptions& o : methods(corners)) {
      const DecimateResult r = run(mesh, o);
      EXPECT_EQ(r.mesh.vertices.size(), corners);
      expect_same(mesh, r.mesh);
      EXPECT_TRUE(geom::analyse(r.mesh).closed());
    }
  }
}

TEST(Flat, StopsAtTheWishedNumber) {
  DecimateOptions o;
  o.vertices = 100;
  const geom::Mesh cube = test::box({1, 1, 1}, 8);
  const DecimateResult r = run(cube, o);
  EXPECT_EQ(r.mesh.vertices.size(), 100U);
  expect_same(cube, r.mesh);
}

TEST(Flat, CostsNothingOfAnErrorBound) {
  DecimateOptions o;
  o.epsilon = 1e-9;
  const geom::Mesh mesh = plate(2);
  const DecimateResult r = run(mesh, o);
  EXPECT_EQ(r.mesh.vertices.size(), 40U);
  expect_same(mesh, r.mesh);
}

// Slivers: rim fans of valence 100, side walls of rows. Only the rows in between may go.
TEST(Flat, CylindersKeepTheirRims) {
  for (const int rings : {0, 3}) {
    const geom::Mesh mesh = test::to_float(test::cylinder(100, 2, 6, rings));
    DecimateOptions o;
    o.epsilon = 1e-9;
    const DecimateResult r = run(mesh, o);
    EXPECT_LE(r.mesh.vertices.size(), 202U);
    EXPECT_GE(r.mesh.vertices.size(), 200U);
    expect_same(mesh, r.mesh);
  }
}

// A border does not move, even on a line.
TEST(Flat, LeavesBordersAlone) {
  DecimateOptions o;
  o.vertices = 4;
  const geom::Mesh mesh = test::grid(6, [](double, double) { return 0.0; });
  const DecimateResult r = run(mesh, o);
  EXPECT_EQ(r.mesh.vertices.size(), 24U);
  EXPECT_EQ(r.stop, Stop::Exhausted);
}

}  // namespace
