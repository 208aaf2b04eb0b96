#include "outward.h"

#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/float32.h>

#include <cmath>
#include <numbers>
#include <random>

#include "simplify.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

/// Exactly: a float32 polytope that contains the points.
void expect_enclosed(const geom::Mesh& body, const std::vector<Vec3>& points) {
  EXPECT_TRUE(geom::is_convex(body));
  EXPECT_TRUE(kaboum::test::exactly_convex(body));
  for (const Vec3& p : body.vertices) EXPECT_TRUE(geom::is_float32(p));
  for (const Vec3& p : points) {
    const auto w = kaboum::test::winding_number_slow(body, p);
    EXPECT_TRUE(!w || *w == 1) << p.transpose();
  }
}

std::vector<Vec3> rounded(std::vector<Vec3> points) {
  for (Vec3& p : points) p = geom::to_float32(p);
  return points;
}

TEST(Enclose, ShapesThatAreALittleTooSmall) {
  for (const auto cloud : {kaboum::test::Cloud::Ball, kaboum::test::Cloud::Cube})
    for (std::uint32_t seed = 0; seed < 6; ++seed)
      for (const double offset : {0.0, 1000.0}) {
        std::vector<Vec3> points = kaboum::test::random_hull(40, cloud, seed).vertices;
        for (Vec3& p : points) p += Vec3(offset, 0, -offset);
        const std::vector<Vec3> required = rounded(points);
        const geom::Mesh body = enclose(points, required, 1000);
        expect_enclosed(body, required);
        // Moved by little.
        for (const Vec3& v : body.vertices) {
          double nearest = 1e9;
          for (const Vec3& p : points) nearest = std::min(nearest, (v - p).norm());
          EXPECT_LT(nearest, 1e-4 * (1 + offset * 1e-1));
        }
      }
}

TEST(Enclose, ThinAndFlatOnes) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double thickness : {1e-3, 1e-7, 1e-12, 0.0}) {
    std::vector<Vec3> points;
    for (int i = 0; i < 30; ++i) {
      const double x = unit(random), y = unit(random);
      points.emplace_back(x, y, 0.3 * x - 0.2 * y + thickness * unit(random));
    }
    const std::vector<Vec3> required = rounded(points);
    const geom::Mesh body = enclose(points, required, 16);
    expect_enclosed(body, required);
  }
}

/// A box would reach 0.41 beyond the disc; with 16 sides it is 0.02.
TEST(Enclose, ThinDiscsByPrismsWithAsManySidesAsAllowed) {
  for (const double thickness : {1e-5, 0.0}) {
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i)
      for (const double z : {0.0, thickness})
        points.emplace_back(std::cos(i * std::numbers::pi / 100), z,
                            std::sin(i * std::numbers::pi / 100));
    const std::vector<Vec3> required = rounded(points);
    const geom::Mesh body = enclose(points, required, 32);
    expect_enclosed(body, required);
    EXPECT_LE(body.vertices.size(), 32U);
    for (const Vec3& v : body.vertices) EXPECT_LT(v.norm(), 1.03);
  }
}

TEST(PrismRound, LiesOnFacetsHoweverUnevenlyPointsAreSpread) {
  // A slab; many points at two opposite corners turn the axes of covariance.
  const Vec3 size(0.2, 0.005, 0.1);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.4, Vec3::UnitX()) * Eigen::AngleAxisd(0.7, Vec3::UnitZ()))
          .toRotationMatrix();
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = size.cwiseProduct(Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
    for (int k = 0; k < (i == 0 || i == 7 ? 30 : 1); ++k) {
      const Vec3 inwards = (i == 7 ? -1e-4 : 1e-4) * k * Vec3::UnitX();
      points.emplace_back(turn * (corner + inwards));
    }
  }
  const std::vector<Vec3> required = rounded(points);
  const auto prism = prism_round(required, 8);
  ASSERT_TRUE(prism);
  expect_enclosed(*prism, required);
  EXPECT_EQ(prism->vertices.size(), 8U);
  EXPECT_LT(std::abs(geom::signed_volume(*prism)), 1.01 * size.prod());
}

TEST(Simplify, EnclosesUpToRoundingWithinTheCap) {
  for (const int n : {80, 300}) {
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
      const geom::Mesh hull = kaboum::test::random_hull(n, kaboum::test::Cloud::Sphere, seed);
      const SolidField solid(hull, 20000, 0);
      for (const std::size_t cap : {64U, 32U, 16U, 8U}) {
        const Simplified s = simplify(hull.vertices, cap, 0, solid);
        EXPECT_LE(s.vertices.size(), std::max<std::size_t>(cap, 8));
        const std::vector<Vec3> required = rounded(hull.vertices);
        const geom::Mesh body = enclose(s.vertices, required, cap);
        expect_enclosed(body, required);
        EXPECT_LE(body.vertices.size(), std::max<std::size_t>(cap, 8));
      }
    }
  }
}

TEST(OuterPoints, BoxesRoundComputedPoints) {
  Piece piece;
  piece.points = {Vec3(0.5, 0.25, 1), Vec3(0.1, 0.2, 0.3), Vec3(1, 0, 0), Vec3(0, 1, 0.7)};
  piece.exact = {1, 1, 0, 0};
  const std::vector<Vec3> points = outer_points(piece, 1e-9);
  const auto hull = geom::convex_hull(points);
  ASSERT_TRUE(hull.has_value());
  for (const Vec3& p : points) EXPECT_TRUE(geom::is_float32(p));
  for (std::size_t i = 0; i < 4; ++i) {
    for (int k = 0; k < 8; ++k) {
      const double e = piece.exact[i] != 0 ? 0 : 1e-9;
      const Vec3 p = piece.points[i] +
                     e * Vec3((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
      const auto w = kaboum::test::winding_number_slow(*hull, p);
      EXPECT_TRUE(!w || *w == 1);
    }
  }
}

}  // namespace
}  // namespace kaboum::bcd
