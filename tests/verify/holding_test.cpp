// What convex bodies hold, decided to the last bit.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/verify/holding.h>

#include <cmath>
#include <limits>

namespace kaboum::verify {
namespace {

using geom::Vec3;

geom::ConvexSet cube(double half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half,
                         (i & 4) != 0 ? half : -half);
  geom::ConvexSet set;
  set.bodies.push_back({"cube", *geom::convex_hull(corners)});
  return set;
}

/// The octahedron |x| + |y| + |z| ≤ 3, whose faces are √3 from its middle.
geom::ConvexSet octahedron() {
  std::vector<Vec3> corners;
  for (const double s : {-3.0, 3.0})
    for (int axis = 0; axis < 3; ++axis) corners.emplace_back(s * Vec3::Unit(axis));
  geom::ConvexSet set;
  set.bodies.push_back({"octahedron", *geom::convex_hull(corners)});
  return set;
}

Answer decide(const geom::ConvexSet& set, const RoundedHull& held) {
  return verify_holding(set, {&held, 1}).answer;
}

TEST(Holding, IsDecidedToTheLastBit) {
  const double more = std::nextafter(1.0, 2.0), tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(decide(cube(1), {{{0, 0, 0}}, 1}), Answer::Verified);
  EXPECT_EQ(decide(cube(1), {{{0, 0, 0}}, more}), Answer::Refuted);
  EXPECT_EQ(decide(cube(1), {{{1, 1, 1}, {-1, 1, -1}}, 0}), Answer::Verified);
  EXPECT_EQ(decide(cube(1), {{{1, 1, 1}, {-1, 1, -1}}, tiny}), Answer::Refuted);
  EXPECT_EQ(decide(cube(1), {{{more, 0, 0}}, 0}), Answer::Refuted);
  // 3 of the numbers are exact, √3 is not: the doubles on both sides of it.
  double below = std::sqrt(3.0);
  if (static_cast<long double>(below) * below > 3) below = std::nextafter(below, 0.0);
  EXPECT_EQ(decide(octahedron(), {{{0, 0, 0}}, below}), Answer::Verified);
  EXPECT_EQ(decide(octahedron(), {{{0, 0, 0}}, std::nextafter(below, 2.0)}), Answer::Refuted);
}

TEST(Holding, NeedsConvexBodiesAndOneForEach) {
  geom::ConvexSet set = cube(1);
  EXPECT_EQ(verify_holding(set, {}).answer, Answer::Refuted);
  set.bodies[0].core.triangles.pop_back();
  EXPECT_EQ(decide(set, {{{0, 0, 0}}, 0.5}), Answer::Refuted);
  EXPECT_THROW(decide(cube(1), {{{0, 0, 0}}, -1}), Error);
  EXPECT_THROW(decide(cube(1), {{{0, 0, std::nan("")}}, 1}), Error);
  EXPECT_THROW(decide(cube(1), {{{0, 0, 0}}, std::nan("")}), Error);
}

}  // namespace
}  // namespace kaboum::verify
