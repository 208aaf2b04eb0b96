// Brackets of how far something lies outside: they hold the truth, and are narrow.
#include <kaboum/verify/bracket.h>

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "pairs.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test
using verify::Answer;
using verify::Bracket;

Mesh block(const Vec3& low, const Vec3& high) { return translated(box(high - low, 1), low); }

void expect_near(const Bracket& b, double truth, const char* what) {
  EXPECT_LE(b.lower, truth) << what;
  EXPECT_GE(b.upper, truth) << what;
  EXPECT_GE(b.lower, truth * (1 - 3e-3)) << what;
  EXPECT_LE(b.upper, truth * (1 + 3e-3)) << what;
}

Bracket of_surface(const Mesh& inner, const Mesh& outer) {
  const auto claim = verify::verify_inclusion(inner, outer).surface;
  EXPECT_EQ(claim.answer, Answer::Refuted);
  return verify::bracket_distance(inner, claim.inner_triangles, outer, true);
}

Bracket of_solid(const Mesh& inner, const Mesh& outer) {
  const auto claim = verify::verify_inclusion(inner, outer).solid;
  EXPECT_EQ(claim.answer, Answer::Refuted);
  return verify::bracket_solid(inner, outer, claim);
}

TEST(Bracket, BlocksThatStickOut) {
  const Mesh unit = block({0, 0, 0}, {1, 1, 1});
  for (const double out : {1e-9, 0.001, 0.5, 7.0}) {
    const Mesh longer = block({0.25, 0.25, 0.25}, {1 + out, 0.75, 0.75});
    expect_near(of_surface(longer, unit), out, "surface");
    expect_near(of_solid(longer, unit), out, "solid");
  }
  // The farthest of several, not the first.
  const Mesh two = merged(
      {block({0.25, 0.25, 0.5}, {0.75, 0.75, 1.125}), block({0.25, 0.25, -2}, {0.75, 0.75, 0.5})});
  const Bracket b = of_surface(two, unit);
  expect_near(b, 2, "two");
  EXPECT_GE(b.triangle, 12U);
  EXPECT_EQ(b.at.z(), -2);
  expect_near(of_solid(two, unit), 2, "two");
}

// All triangles are enclosed; the farthest point is the middle of the void.
TEST(Bracket, VoidInTheMiddle) {
  const Mesh solid = block(Vec3::Zero(), Vec3::Constant(10));
  const Mesh hollow = merged({solid, flipped(block(Vec3::Constant(3), Vec3::Constant(7)))});
  EXPECT_EQ(verify::verify_inclusion(solid, hollow).surface.answer, Answer::Verified);
  const Bracket b = of_solid(solid, hollow);
  EXPECT_LE(b.lower, 2);
  EXPECT_GE(b.lower, 1.9);
  EXPECT_GE(b.upper, 2);
  EXPECT_LE(b.upper, 2.2);
}

// What the outer mesh has outside its own solid is not near to it.
TEST(Bracket, TrianglesThatBoundNoSolidAreNoTarget) {
  const Mesh unit = block({0, 0, 0}, {1, 1, 1});
  const Mesh with_turned = merged({unit, flipped(block({3, 0, 0}, {4, 1, 1}))});
  expect_near(of_surface(block({3, 0, 0}, {4, 1, 1}), with_turned), 3, "same place");
  expect_near(of_surface(with_turned, with_turned), 3, "itself");
}

TEST(Bracket, OneWayDistancesOfSurfaces) {
  const Mesh a = block({0, 0, 0}, {1, 1, 1}), b = block({0, 0, 0}, {3, 1, 1});
  std::vector<std::uint32_t> all(12);
  std::iota(all.begin(), all.end(), 0U);
  expect_near(verify::bracket_distance(b, all, a, false), 2, "from the longer one");
  expect_near(verify::bracket_distance(a, all, b, false), 0.5, "from the shorter one");
  EXPECT_EQ(verify::bracket_distance(a, all, a, false).lower, 0);
  EXPECT_LE(verify::bracket_distance(a, all, a, false).upper, 1e-12);
}

// Little effort makes brackets wide, never wrong; samples lie within.
TEST(Bracket, AnyEffortHoldsTheTruth) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int round = 0; round < 20; ++round) {
    std::vector<Mesh> blocks;
    for (int i = 0; i < 4; ++i) {
      const Vec3 low(place(random), place(random), place(random));
      blocks.push_back(block(low, low + Vec3::Constant(0.9) +
                                      0.5 * Vec3(place(random), place(random), place(random))));
    }
    const Mesh inner = merged({blocks[0], blocks[1]}), outer = merged({blocks[2], blocks[3]});
    const auto claims = verify::verify_inclusion(inner, outer);
    if (claims.surface.answer != Answer::Refuted) continue;
    const auto& named = claims.surface.inner_triangles;
    const Bracket fine = verify::bracket_distance(inner, named, outer, true);
    for (const std::size_t parts : {0, 10, 200}) {
      const Bracket coarse = verify::bracket_distance(inner, named, outer, true, {parts, 1e-3});
      EXPECT_LE(coarse.lower, fine.upper);
      EXPECT_GE(coarse.upper, fine.lower);
      EXPECT_LE(coarse.lower, coarse.upper);
    }
    EXPECT_LE(fine.upper, fine.lower * 1.01 + 1e-9);
    if (claims.solid.answer != Answer::Refuted) continue;
    const Bracket solid = verify::bracket_solid(inner, outer, claims.solid);
    EXPECT_GE(solid.lower, claims.solid.witness->depth * (1 - 1e-9) - 1e-12);
    EXPECT_LE(solid.lower, solid.upper);
  }
}

}  // namespace
