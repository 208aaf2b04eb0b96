// Cuts of polygons: the parts cover the whole, on their sides of the plane.
#include <kaboum/geom/clip.h>

#include <gtest/gtest.h>

#include <random>

namespace kaboum::geom {
namespace {

double area_of(const ConvexPolygon& p) {
  Vec3 sum = Vec3::Zero();
  for (int i = 1; i + 1 < p.size; ++i)
    sum += (p.corner[i] - p.corner[0]).cross(p.corner[i + 1] - p.corner[0]);
  return 0.5 * sum.norm();
}

struct Draw {
  std::mt19937 random{4};
  std::uniform_real_distribution<double> unit{-1, 1};
  Vec3 point() { return {unit(random), unit(random), unit(random)}; }
  ConvexPolygon triangle() { return {point(), point(), point()}; }
};

TEST(Clip, PartsOfACutCoverTheWholeAndKeepTheirSides) {
  Draw draw;
  int done = 0;
  for (int round = 0; round < 2000; ++round) {
    const ConvexPolygon whole = draw.triangle();
    const Vec3 p = 0.3 * draw.point(), n = draw.point();
    ConvexPolygon below, above;
    double low = 1e9, high = -1e9;
    for (int i = 0; i < whole.size; ++i) {
      low = std::min(low, n.dot(whole.corner[i] - p));
      high = std::max(high, n.dot(whole.corner[i] - p));
    }
    if (!cut(whole, p, n, below, above)) {
      EXPECT_TRUE(low > -1e-6 || high < 1e-6);
      continue;
    }
    ++done;
    EXPECT_LT(low, 0);
    EXPECT_GT(high, 0);
    for (int i = 0; i < below.size; ++i) EXPECT_LE(n.dot(below.corner[i] - p), 1e-14);
    for (int i = 0; i < above.size; ++i) EXPECT_GE(n.dot(above.corner[i] - p), -1e-14);
    EXPECT_NEAR(area_of(below) + area_of(above), area_of(whole), 1e-13);
  }
  EXPECT_GT(done, 500);
}

TEST(Clip, PrismsAndHalvesCoverTheWhole) {
  Draw draw;
  int inside = 0;
  for (int round = 0; round < 1000; ++round) {
    const ConvexPolygon whole = draw.triangle();
    const ConvexPolygon t = draw.triangle();
    const PrismCut pieces =
        cut_by_prism(whole, t.corner[0], t.corner[1], t.corner[2], round % 3 == 0);
    ASSERT_GE(pieces.count, 2);
    double sum = 0;
    for (int i = 0; i < pieces.count; ++i) sum += area_of(pieces.piece[i]);
    EXPECT_NEAR(sum, area_of(whole), 1e-12);
    inside += pieces.count == 4 ? 1 : 0;
    ConvexPolygon first, second;
    halve(whole, first, second);
    EXPECT_NEAR(area_of(first), area_of(second), 0.5 * area_of(whole));
    EXPECT_NEAR(area_of(first) + area_of(second), area_of(whole), 1e-13);
  }
  EXPECT_GT(inside, 20);
}

// Repeated cuts end in polygons at capacity, which still fall apart without loss.
TEST(Clip, ManyCutsLoseNothing) {
  Draw draw;
  for (int round = 0; round < 50; ++round) {
    std::vector<ConvexPolygon> parts{draw.triangle()};
    const double area = area_of(parts[0]);
    for (int k = 0; k < 12; ++k) {
      std::vector<ConvexPolygon> next;
      const Vec3 p = 0.3 * draw.point(), n = draw.point();
      for (const ConvexPolygon& part : parts) {
        ConvexPolygon below, above;
        if (cut(part, p, n, below, above)) {
          next.push_back(below);
          next.push_back(above);
        } else {
          next.push_back(part);
        }
      }
      parts = std::move(next);
    }
    double sum = 0;
    for (const ConvexPolygon& part : parts) sum += area_of(part);
    EXPECT_NEAR(sum, area, 1e-11);
  }
}

TEST(Clip, BisectorsAreAsFarFromBothPlanes) {
  const std::array<Vec3, 3> floor{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
      wall{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  const Vec3 near(0.2, 0.3, 0.25);
  const auto plane = bisector(floor, wall, near, 1e-20);
  ASSERT_TRUE(plane.has_value());
  // x = z on it.
  const Vec3 n = plane->normal.normalized();
  EXPECT_NEAR(std::abs(n.dot(Vec3(1, 0, -1).normalized())), 1, 1e-12);
  EXPECT_NEAR(n.dot(plane->point - Vec3(0.5, 0.1, 0.5)), 0, 1e-12);
  EXPECT_FALSE(bisector(floor, floor, near, 1e-20).has_value());
}

}  // namespace
}  // namespace kaboum::geom
