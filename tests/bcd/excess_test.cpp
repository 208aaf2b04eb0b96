#include "excess.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "solids.h"
#include "support/fan.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using kaboum::test::box;
using kaboum::test::flipped;
using kaboum::test::merged;
using kaboum::test::translated;

Excess excess_of(const Mesh& body, const Mesh& solid_mesh) {
  const SolidField solid(solid_mesh, 20000, 0);
  return measure({body}, solid, {.absolute_gap = 1e-5 * solid.diagonal()})[0];
}

TEST(Excess, HullOfAnL) {
  // The hull's facet from (3,1) to (1,3) is farthest from the corner (1,1): √2.
  const Mesh l = test::prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1);
  const Mesh hull = test::prism({{0, 0}, {3, 0}, {3, 1}, {1, 3}, {0, 3}}, 1);
  const Excess r = excess_of(hull, l);
  EXPECT_LE(r.lower, std::sqrt(2.0) / 2 * 2);
  EXPECT_GE(r.upper, 1.0);
  // d(x) = distance to the two inner walls: the point (2,2) is at distance 1.
  EXPECT_LE(r.lower, 1.0 + 1e-9);
  EXPECT_GE(r.lower, 0.97);
  EXPECT_LE(r.upper, 1.03);
}

TEST(Excess, CavitiesCount) {
  // A box with a cubic cavity of side 1: its centre is half a unit from the solid, though every
  // facet of the hull lies on it.
  const Mesh cavity = flipped(translated(box(Vec3(1, 1, 1), 1), Vec3(1, 1, 1)));
  const Mesh solid = merged({box(Vec3(3, 3, 3), 1), cavity});
  const Excess r = excess_of(box(Vec3(3, 3, 3), 1), solid);
  EXPECT_LE(r.lower, 0.5 + 1e-9);
  EXPECT_GE(r.lower, 0.48);
  EXPECT_GE(r.upper, 0.5);
  EXPECT_LE(r.upper, 0.52);
}

TEST(Excess, WhereverCavitiesAre) {
  // Farthest is the middle of the widest one; cubes meet them in every way.
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 12; ++round) {
    const Mesh block = box(Vec3(3, 3, 3), 1);
    Mesh solid = block;
    double expected = 0;
    for (int i = 0; i < 1 + round % 3; ++i) {
      const Vec3 size = (0.3 + 0.6 * unit(random)) * Vec3(1, 1.05, 1.1);
      const Vec3 at(0.005 + i, 0.01 + 1.9 * unit(random), 0.01 + 1.9 * unit(random));
      solid = merged({solid, flipped(translated(box(size, 1), at))});
      expected = std::max(expected, 0.5 * size.minCoeff());
    }
    const Excess r = excess_of(block, solid);
    EXPECT_GE(r.upper, expected);
    EXPECT_LE(r.lower, expected + 1e-9);
    EXPECT_LE(r.upper, 1.03 * expected);
  }
}

TEST(Excess, StopsWhereItIsKnownToBeTooFar) {
  const Mesh l = test::prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1);
  const Mesh hull = test::prism({{0, 0}, {3, 0}, {3, 1}, {1, 3}, {0, 3}}, 1);
  const SolidField solid(l, 20000, 0);
  const Excess far = measure({hull}, solid, {.cutoff = 0.5})[0];
  EXPECT_GT(far.lower, 0.5);
  EXPECT_LE(far.lower, 1.0 + 1e-9);
  EXPECT_EQ(far.upper, std::numeric_limits<double>::infinity());
  EXPECT_LE(measure({hull}, solid, {.cutoff = 1.1})[0].upper, 1.03);
}

TEST(Excess, InsideIsZero) {
  const Excess r =
      excess_of(translated(box(Vec3(1, 1, 1), 1), Vec3(1, 1, 1)), box(Vec3(3, 3, 3), 1));
  EXPECT_EQ(r.lower, 0);
  EXPECT_LE(r.upper, 1e-3);
}

TEST(Excess, BodiesOnTheSolidCostLittle) {
  // Facets of several triangles each; were the bound that of cubes alone, millions would be needed.
  const Mesh grid = test::prism({{0, 0}, {2, 0}, {3, 1}, {3, 3}, {1, 3}, {0, 2}}, 1);
  for (const Mesh& mesh : {grid, kaboum::test::icosphere(1)}) {
    const SolidField solid(mesh, 20000, 0);
    ExcessOptions options;
    options.absolute_gap = 1e-5;
    options.max_parts = 3000;
    EXPECT_LE(measure({mesh}, solid, options)[0].upper, 1e-5);
    // The distance to a convex solid is convex: largest at a vertex.
    Mesh larger = mesh;
    for (Vec3& p : larger.vertices) p *= 1.01;
    const Excess r = measure({larger}, solid, {})[0];
    double farthest = 0;
    for (const Vec3& p : larger.vertices)
      if (!solid.contains(p)) farthest = std::max(farthest, solid.surface().nearest(p).lower);
    EXPECT_GE(r.upper, farthest);
    EXPECT_LE(r.upper, 1.03 * farthest);
  }
}

TEST(Excess, EndsWithTheWork) {
  // Of a thousand needles, many are equally near to what is inside.
  const Mesh fan = kaboum::test::double_fan(1000);
  const SolidField solid(fan, 20000, 0);
  Mesh body = kaboum::test::double_fan(16);
  for (Vec3& p : body.vertices) p *= 1.05;
  const Excess all = measure({body}, solid, {})[0];
  const std::uint64_t before = solid.work().done();
  const Excess some = measure({body}, solid, {.work = 2'000'000})[0];
  const std::uint64_t done = solid.work().done() - before;
  EXPECT_GT(before, 2 * done);
  EXPECT_LT(done, 4'000'000U);
  EXPECT_GE(some.upper, all.lower);
  EXPECT_LE(some.lower, all.upper);
  EXPECT_LT(some.upper, 1.5);
}

TEST(Excess, NoPointIsFarther) {
  const Mesh torus = kaboum::test::torus(1, 0.3, 24, 12);
  const SolidField solid(torus, 20000, 0);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    Mesh body = kaboum::test::random_hull(12, kaboum::test::Cloud::Ball, seed);
    for (Vec3& p : body.vertices) p = p.cwiseProduct(Vec3(1.3, 1.3, 0.4));
    const Excess r = measure({body}, solid, {})[0];
    EXPECT_LE(r.lower, r.upper);
    EXPECT_LE(r.upper, 1.05 * r.lower + 1e-3);
    for (int i = 0; i < 4000; ++i) {
      // Convex combinations of corners.
      Vec3 p = Vec3::Zero();
      double sum = 0;
      for (const Vec3& v : body.vertices) {
        const double w = -std::log(1e-12 + unit(random));
        p += w * v;
        sum += w;
      }
      p /= sum;
      if (!solid.contains(p)) {
        EXPECT_LE(solid.surface().nearest(p).lower, r.upper);
      }
    }
  }
}

// Those that are not the farthest are measured as far as is asked for; that changes nothing of the
// farthest one.
TEST(Excess, OfManyTheFarthestIsMeasured) {
  const Mesh inner = box(Vec3(3, 3, 3), 1);
  const SolidField solid(inner, 20000, 0);
  std::vector<Mesh> bodies;
  for (const double beyond : {0.1, 0.4, 0.38, 0.05})
    bodies.push_back(box(Vec3(3, 3, 3 + beyond), 1));
  for (const double share : {0.7, 0.97}) {
    const std::vector<Excess> found =
        measure(bodies, solid, {.absolute_gap = 1e-5, .worth_measuring = share});
    EXPECT_LE(found[1].lower, 0.4 + 1e-9);
    EXPECT_GE(found[1].upper, 0.4);
    EXPECT_LE(found[1].upper, 0.4 * 1.03);
    for (const Excess& e : found) EXPECT_LE(e.upper, found[1].upper);
    EXPECT_GE(found[0].upper, 0.1);
    EXPECT_GE(found[2].upper, 0.38);
  }
}

}  // namespace
}  // namespace kaboum::bcd
