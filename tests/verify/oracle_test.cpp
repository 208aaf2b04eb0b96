// The exact oracle itself, against cases that need no computation and against winding numbers
// counted another way.
#include <gtest/gtest.h>

#include <random>

#include "pairs.h"
#include "support/arrangement_oracle.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test

Mesh cube(double size, double at) {
  return translated(box(Vec3::Constant(size), 1), Vec3::Constant(at));
}

TEST(ArrangementOracle, BoxInBox) {
  const auto v = arrangement_verdict(cube(1, 1), cube(3, 0));
  EXPECT_TRUE(v.inner_closed && v.outer_closed);
  EXPECT_EQ(v.solid, true);
  EXPECT_EQ(v.surface, true);
  EXPECT_FALSE(v.same_border && !v.difference);
  const auto back = arrangement_verdict(cube(3, 0), cube(1, 1));
  EXPECT_EQ(back.solid, false);
  EXPECT_EQ(back.surface, false);
  EXPECT_EQ(back.surface_faults, 12U);
}

TEST(ArrangementOracle, OverlappingCubesShareNoClaim) {
  const auto v = arrangement_verdict(cube(2, 0), cube(2, 1));
  EXPECT_EQ(v.solid, false);
  EXPECT_EQ(v.surface, false);
}

TEST(ArrangementOracle, OneSurfaceTwice) {
  for (const Mesh& m : {cube(2, 0), icosphere(1)}) {
    const auto v = arrangement_verdict(m, m);
    EXPECT_EQ(v.solid, true);
    EXPECT_EQ(v.surface, true);
    EXPECT_EQ(v.difference, true);
  }
  const auto grids = arrangement_verdict(box({6, 6, 6}, 2), box({6, 6, 6}, 3));
  EXPECT_EQ(grids.solid, true);
  EXPECT_EQ(grids.surface, true);
}

TEST(ArrangementOracle, SheetsHaveNoSolidButASurface) {
  const Mesh sheet{{{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  const auto v = arrangement_verdict(sheet, cube(1, 0));
  EXPECT_EQ(v.solid, true);
  EXPECT_EQ(v.surface, false);
  EXPECT_EQ(v.surface_faults, 2U);
}

TEST(ArrangementOracle, CavityIsNoPartOfTheSolid) {
  const Mesh shell = merged({cube(4, 0), flipped(cube(2, 1))});
  EXPECT_EQ(arrangement_verdict(cube(1, 1), shell).solid, false);
  EXPECT_EQ(arrangement_verdict(shell, cube(4, 0)).solid, true);
  EXPECT_EQ(arrangement_verdict(shell, cube(4, 0)).surface, true);
  EXPECT_EQ(arrangement_verdict(cube(4, 0), shell).solid, false);
  // Its surface is not outside: the cavity's walls bound the solid.
  EXPECT_EQ(arrangement_verdict(cube(2, 1), shell).surface, true);
  EXPECT_EQ(arrangement_verdict(cube(2, 1), shell).solid, false);
}

TEST(ArrangementOracle, InvertedHasNoSolid) {
  EXPECT_EQ(arrangement_verdict(flipped(cube(9, -3)), cube(1, 0)).solid, true);
  EXPECT_EQ(arrangement_verdict(flipped(cube(9, -3)), cube(1, 0)).surface, false);
  EXPECT_EQ(arrangement_verdict(cube(1, 0), flipped(cube(9, -3))).solid, false);
}

TEST(ArrangementOracle, OpenMeshes) {
  Mesh half = cube(1, 0);
  half.triangles.pop_back();
  const auto v = arrangement_verdict(half, cube(1, 0));
  EXPECT_FALSE(v.inner_closed);
  EXPECT_EQ(v.solid, std::nullopt);
  EXPECT_EQ(v.difference, std::nullopt);
  EXPECT_EQ(v.surface, true);
  const auto same = arrangement_verdict(half, merged({half, cube(1, 5)}));
  EXPECT_TRUE(same.same_border);
  EXPECT_EQ(same.difference, true);
  EXPECT_EQ(same.surface, std::nullopt);
  EXPECT_EQ(arrangement_verdict(merged({half, cube(1, 5)}), half).difference, false);
}

TEST(ArrangementOracle, NothingInNothing) {
  EXPECT_EQ(arrangement_verdict({}, {}).solid, true);
  EXPECT_EQ(arrangement_verdict({}, cube(1, 0)).surface, true);
  EXPECT_EQ(arrangement_verdict(cube(1, 0), {}).solid, false);
  EXPECT_EQ(arrangement_verdict(cube(1, 0), {}).surface, false);
}

// If the oracle says yes, no point anywhere contradicts it; if it says no, some point
// beside a triangle does, for the regions of lattice chains are not small.
TEST(ArrangementOracle, AgreesWithWindingNumbersOfPoints) {
  int yes = 0, no = 0, confirmed = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const MeshPair pair = lattice_pair(seed);
    const auto verdict = arrangement_verdict(pair.inner, pair.outer);
    ASSERT_TRUE(verdict.solid.has_value()) << pair.name;
    Random random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    bool found = false;
    for (int i = 0; i < 120 && !found; ++i) {  // beside the triangles of both
      const Mesh& mesh = i % 2 == 0 ? pair.inner : pair.outer;
      if (mesh.triangles.empty()) continue;
      const auto& t = mesh.triangles[random() % mesh.triangles.size()];
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      double u = unit(random), v = unit(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3 p = a + u * (b - a) + v * (c - a) +
                     1e-3 * Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
      const auto wa = winding_number_slow(pair.inner, p), wb = winding_number_slow(pair.outer, p);
      found = wa && wb && *wa >= 1 && *wb <= 0;
    }
    if (*verdict.solid) {
      ++yes;
      EXPECT_FALSE(found) << pair.name;
    } else {
      ++no;
      confirmed += found ? 1 : 0;
    }
  }
  EXPECT_GE(yes, 10);
  EXPECT_GE(no, 10);
  EXPECT_GE(confirmed * 10, no * 9);
}

}  // namespace
