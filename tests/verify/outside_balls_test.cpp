// Shares and depths of triangles outside of balls, against formulas and fine samples.
#include <gtest/gtest.h>
#include <kaboum/verify/ball_cover.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace kaboum::verify {
namespace {

using geom::Vec3;

geom::Mesh triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

geom::ConvexSet balls_of(const std::vector<std::pair<Vec3, double>>& balls) {
  geom::ConvexSet out;
  for (const auto& [center, radius] : balls) {
    geom::ConvexBody body;
    body.core.vertices = {center};
    body.radius = radius;
    out.bodies.push_back(body);
  }
  return out;
}

void expect_in(double value, double lower, double upper, double room) {
  EXPECT_LE(lower - room, value);
  EXPECT_GE(upper + room, value);
  EXPECT_LE(upper - lower, room + 2e-3);
}

TEST(OutsideBalls, ADiscInATriangleHasItsArea) {
  for (const double scale : {1e-3, 1.0, 1e3})
    for (const double height : {0.0, 0.3, 0.999, 1.0, 1.5}) {
      const geom::Mesh mesh =
          triangle(scale * Vec3(-4, -2, 0), scale * Vec3(4, -2, 0), scale * Vec3(0, 6, 0));
      const OutsideBalls found =
          measure_outside_balls(mesh, balls_of({{scale * Vec3(0, 0, height), scale}}));
      const double disc = std::numbers::pi * std::max(0.0, 1 - height * height);
      const double share = 1 - disc / 32;
      EXPECT_LE(found.share_lower, share) << scale << " " << height;
      EXPECT_GE(found.share_upper, share) << scale << " " << height;
      EXPECT_LE(found.share_upper - found.share_lower, 1e-6) << scale << " " << height;
      const double depth = scale * (std::sqrt(36 + height * height) - 1);  // of the third corner
      EXPECT_LE(found.depth_lower, depth * (1 + 1e-12));
      EXPECT_GE(found.depth_upper, depth * (1 - 1e-12));
    }
}

TEST(OutsideBalls, AHalfDiscAndACornerHaveTheirAreas) {
  // The ball's middle on an edge, and at a corner of a right angle.
  const geom::Mesh mesh = triangle({0, 0, 0}, {8, 0, 0}, {0, 8, 0});
  const OutsideBalls edge = measure_outside_balls(mesh, balls_of({{{3, 0, 0}, 1}})),
                     corner = measure_outside_balls(mesh, balls_of({{{0, 0, 0}, 2}}));
  expect_in(1 - std::numbers::pi / 2 / 32, edge.share_lower, edge.share_upper, 1e-9);
  expect_in(1 - std::numbers::pi / 32, corner.share_lower, corner.share_upper, 1e-9);
}

TEST(OutsideBalls, BracketsHoldWhatFineSamplesSay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  for (int round = 0; round < 60; ++round) {
    const Vec3 a = point(), b = point();
    // Some are slivers.
    const Vec3 c = round % 4 == 0 ? Vec3(0.5 * (a + b) + 1e-5 * point()) : point();
    std::vector<std::pair<Vec3, double>> balls;
    for (int i = 0; i <= round % 5; ++i)
      balls.emplace_back(0.7 * point(), 0.2 + 0.4 * std::abs(unit(random)));
    const OutsideBalls found = measure_outside_balls(triangle(a, b, c), balls_of(balls));
    // Middles of n² equal parts: all but those that the border of a ball crosses are right.
    constexpr int kParts = 300;
    int outside = 0;
    double depth = 0;
    for (int i = 0; i < kParts; ++i)
      for (int k = 0; k < kParts - i; ++k)
        for (const double third : {1.0 / 3, 2.0 / 3}) {
          if (third > 0.5 && i + k + 1 >= kParts) continue;
          const double s = (i + third) / kParts, t = (k + third) / kParts;
          const Vec3 p = a + s * (b - a) + t * (c - a);
          double height = 1e9;
          for (const auto& [center, radius] : balls)
            height = std::min(height, (p - center).norm() - radius);
          outside += height > 0 ? 1 : 0;
          depth = std::max(depth, height);
        }
    expect_in(static_cast<double>(outside) / (kParts * kParts), found.share_lower,
              found.share_upper, 0.02);
    EXPECT_LE(depth, found.depth_upper + 1e-9) << round;
    EXPECT_LE(found.depth_upper, 1.001 * found.depth_lower + 1e-9) << round;
  }
}

TEST(OutsideBalls, AllIsOutsideOfNoneAndNothingOfALargeOne) {
  const geom::Mesh mesh = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const OutsideBalls none = measure_outside_balls(mesh, {}),
                     all = measure_outside_balls(mesh, balls_of({{{0, 0, 0}, 2}}));
  EXPECT_EQ(none.share_upper, 1);
  EXPECT_GE(none.share_lower, 1 - 1e-8);
  EXPECT_FALSE(std::isfinite(none.depth_upper));
  EXPECT_EQ(all.share_upper, 0);
  EXPECT_EQ(all.depth_upper, 0);
}

}  // namespace
}  // namespace kaboum::verify
