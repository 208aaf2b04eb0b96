#include "nearly_within.h"

#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>

#include <random>

#include "solids.h"
#include "support/families.h"

namespace kaboum::bcd {
namespace {

constexpr double kSlack = 1e-12;

Mesh box_between(const Vec3& low, const Vec3& high) {
  return kaboum::test::translated(kaboum::test::box(high - low, 1), low);
}

TEST(NearlyWithin, FlushPitsAndCavities) {
  const Mesh letter = test::prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1);
  const Solid solid(letter, 5000, 0);
  // One arm, a little too large; with a face inside the solid, too.
  const Mesh arm = box_between(Vec3::Constant(-1e-6), Vec3(3, 1, 1));
  EXPECT_TRUE(nearly_within(arm, solid, 0.01, kSlack));
  EXPECT_TRUE(nearly_within(arm, solid, 1e-5, kSlack));
  EXPECT_FALSE(nearly_within(arm, solid, 1e-6, kSlack));
  EXPECT_FALSE(nearly_within(*geom::convex_hull(letter.vertices), solid, 0.3, kSlack));
  EXPECT_FALSE(nearly_within(box_between(Vec3(2, 2, 0), Vec3(3, 3, 1)), solid, 0.3, kSlack));
  // A cavity that no facet of the body is near to.
  const Mesh hollow = kaboum::test::merged(
      {box_between(Vec3::Zero(), Vec3::Constant(3)),
       kaboum::test::flipped(box_between(Vec3::Constant(1.4), Vec3::Constant(1.6)))});
  const Solid with_cavity(hollow, 5000, 0);
  EXPECT_FALSE(
      nearly_within(box_between(Vec3::Zero(), Vec3::Constant(3)), with_cavity, 0.05, kSlack));
  EXPECT_TRUE(nearly_within(box_between(Vec3::Zero(), Vec3(3, 3, 1.3)), with_cavity, 0.05, kSlack));
}

TEST(NearlyWithin, NoPointIsFartherWhereItSaysSo) {
  const Mesh ground = kaboum::test::torus(1, 0.4, 16, 8);
  const Solid solid(ground, 20000, 0);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  int certain = 0, not_certain = 0;
  for (int trial = 0; trial < 80; ++trial) {
    // Hulls round a point of the tube's middle.
    const double angle = 6.28 * unit(random), size = 0.15 + 0.45 * unit(random);
    std::vector<Vec3> points;
    points.reserve(12);
    for (int i = 0; i < 12; ++i)
      points.emplace_back(Vec3(std::cos(angle), std::sin(angle), 0) +
                          size * Vec3(normal(random), normal(random), normal(random)).normalized());
    const Mesh body = *geom::convex_hull(points);
    const double distance = 0.02 + 0.05 * unit(random);
    if (!nearly_within(body, solid, distance, kSlack)) {
      ++not_certain;
      continue;
    }
    ++certain;
    for (int i = 0; i < 24; ++i) {
      Vec3 p = Vec3::Zero();
      double sum = 0;
      for (const Vec3& v : body.vertices) {
        const double weight = std::pow(unit(random), 6);
        p += weight * v;
        sum += weight;
      }
      if (i < static_cast<int>(body.vertices.size())) {
        p = body.vertices[static_cast<std::size_t>(i)];
        sum = 1;
      }
      p /= sum;
      const auto w = kaboum::test::winding_number_slow(ground, p);
      if (w && *w >= 1) continue;
      EXPECT_LE(solid.surface().nearest(p).lower, distance);
    }
  }
  EXPECT_GE(certain, 20);
  EXPECT_GE(not_certain, 20);
}

}  // namespace
}  // namespace kaboum::bcd
