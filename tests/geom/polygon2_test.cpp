// Convex polygons against every pair and every point of random ones.
#include <gtest/gtest.h>
#include <kaboum/geom/polygon2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace kaboum::geom {
namespace {

class Polygons2 : public ::testing::Test {
 protected:
  std::vector<Vec2> points(std::size_t count) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < count; ++i) out.emplace_back(number_(random_), number_(random_));
    return out;
  }
  Vec2 point() { return points(1).front(); }

  std::mt19937 random_{7};
  std::uniform_real_distribution<double> number_{-1, 1};
};

/// Whether all of a set is on the left of the line from a to b.
bool is_border(const std::vector<Vec2>& points, const Vec2& a, const Vec2& b) {
  return std::ranges::all_of(points, [&](const Vec2& p) {
    return (b - a).x() * (p - a).y() >= (b - a).y() * (p - a).x();
  });
}

TEST_F(Polygons2, HullsHaveTheEdgesWithAllPointsOnTheirLeft) {
  for (int round = 0; round < 50; ++round) {
    const std::vector<Vec2> set = points(12);
    const Polygon2 hull = convex_hull(set);
    ASSERT_GE(hull.size(), 3U);
    std::size_t borders = 0;
    for (const Vec2& a : set)
      for (const Vec2& b : set)
        if (a != b && is_border(set, a, b)) ++borders;
    EXPECT_EQ(hull.size(), borders);
    for (std::size_t i = 0; i < hull.size(); ++i)
      EXPECT_TRUE(is_border(set, hull[i], hull[(i + 1) % hull.size()]));
  }
}

TEST_F(Polygons2, HullsOfLinesAndPointsHaveNoArea) {
  EXPECT_LT(convex_hull({}).size(), 3U);
  EXPECT_LT(convex_hull({{1, 2}, {1, 2}}).size(), 3U);
  const Polygon2 line = convex_hull({{0, 0}, {1, 1}, {2, 2}});
  EXPECT_EQ(centroid_of(line).area, 0);
  EXPECT_EQ(width_of(line), 0);
  EXPECT_FALSE(holds(line, {1, 1}, 0));
}

TEST_F(Polygons2, CommonPartsAreWhatBothHold) {
  for (int round = 0; round < 50; ++round) {
    const Polygon2 a = convex_hull(points(6)), b = convex_hull(points(6));
    const Polygon2 both = common_part(a, b);
    for (int k = 0; k < 200; ++k) {
      const Vec2 p = point();
      const bool in_both = holds(a, p, 1e-9) && holds(b, p, 1e-9);
      const bool outside = !holds(a, p, -1e-9) || !holds(b, p, -1e-9);
      if (in_both) EXPECT_TRUE(holds(both, p, 0));
      if (outside) EXPECT_FALSE(holds(both, p, 0));
    }
  }
}

TEST_F(Polygons2, ErodedOnesAreWhatIsFarFromAllEdges) {
  for (int round = 0; round < 50; ++round) {
    const Polygon2 a = convex_hull(points(8));
    const Polygon2 less = eroded(a, 0.2);
    for (int k = 0; k < 200; ++k) {
      const Vec2 p = point();
      if (holds(a, p, 0.2 + 1e-9)) EXPECT_TRUE(holds(less, p, 0));
      if (!holds(a, p, 0.2 - 1e-9)) EXPECT_FALSE(holds(less, p, 0));
    }
  }
}

TEST_F(Polygons2, WidthIsTheLeastExtentOfAllDirections) {
  for (int round = 0; round < 20; ++round) {
    const Polygon2 a = convex_hull(points(7));
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 20'000; ++k) {
      const double angle = std::numbers::pi * k / 20'000;
      const Vec2 along(std::cos(angle), std::sin(angle));
      const auto [low, high] =
          std::ranges::minmax(a, {}, [&](const Vec2& p) { return along.dot(p); });
      least = std::min(least, along.dot(high - low));
    }
    EXPECT_LE(width_of(a), least + 1e-12);
    EXPECT_GE(width_of(a), least - 1e-3);
  }
}

TEST_F(Polygons2, CentroidsAreThoseOfSamples) {
  const Polygon2 a = convex_hull(points(8));
  Vec2 sum = Vec2::Zero();
  int inside = 0;
  constexpr int kSamples = 200'000;
  for (int k = 0; k < kSamples; ++k) {
    const Vec2 p = point();
    if (!holds(a, p, 0)) continue;
    sum += p;
    ++inside;
  }
  EXPECT_NEAR(centroid_of(a).area, 4.0 * inside / kSamples, 0.02);
  EXPECT_LT((centroid_of(a).place - sum / inside).norm(), 0.01);
}

TEST_F(Polygons2, RaysReachTheEdgeThatTheyMeet) {
  const Polygon2 square{{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  EXPECT_DOUBLE_EQ(reach_within(square, {0.5, 0.5}, {1, 0}), 1.5);
  EXPECT_DOUBLE_EQ(reach_within(square, {0.5, 0.5}, {0, 2}), 0.25);
  EXPECT_EQ(longest_edge(square), Vec2(1, 0));
}

}  // namespace
}  // namespace kaboum::geom
