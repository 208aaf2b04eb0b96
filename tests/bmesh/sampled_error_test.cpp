#include "sampled_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "nearest_of.h"
#include "support/shapes.h"

namespace {

using kaboum::bmesh::ClosestTriangle;
using kaboum::bmesh::Connectivity;
using kaboum::bmesh::NearestOf;
using kaboum::bmesh::NewTriangle;
using kaboum::bmesh::SampledError;
using kaboum::geom::Vec3;

// The original between its vertices is seen, each place once.
TEST(SampledError, RefinesWherePlacesAreFarOnce) {
  const auto sphere = kaboum::test::icosphere(3);
  Connectivity mesh(sphere.vertices.size(), sphere.triangles);
  SampledError deviation(sphere);
  deviation.assign(sphere.vertices, mesh);
  const std::size_t before = deviation.samples();
  deviation.refine(sphere.vertices, mesh, 1e-8);
  EXPECT_EQ(deviation.samples(), before);  // nothing is far from itself
  std::vector<kaboum::geom::Vec3> smaller;
  for (const auto& p : sphere.vertices) smaller.emplace_back(0.9 * p);
  deviation.assign(smaller, mesh);
  deviation.refine(smaller, mesh, 0.05 * 0.05);
  const std::size_t refined = deviation.samples();
  EXPECT_GT(refined, before);
  deviation.refine(smaller, mesh, 0.05 * 0.05);
  EXPECT_EQ(deviation.samples(), refined);
}

// Long narrow triangles were given dozens of samples each, which made all that looks at them slow.
TEST(SampledError, NarrowTrianglesHaveFewSamples) {
  const auto rod = kaboum::test::cylinder(200, 1, 1, 0);
  const SampledError plain(rod), dense(rod, 4, 0.01);
  EXPECT_LT(dense.samples(), plain.samples() + 6 * rod.triangles.size() + 6000);
}

/// Triangles around the origin: ordinary ones, needles, some without area.
std::vector<NewTriangle> scattered(int count, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> at(-size, size);
  std::vector<NewTriangle> triangles;
  for (int i = 0; i < count; ++i) {
    NewTriangle t{static_cast<std::uint32_t>(i), {}};
    for (Vec3& p : t.corner) p = {at(random), at(random), at(random)};
    if (i % 3 == 1) t.corner[2] = t.corner[0] + 1e-6 * (t.corner[2] - t.corner[1]);
    if (i % 7 == 2) t.corner[2] = t.corner[1];
    triangles.push_back(t);
  }
  return triangles;
}

// What is passed over in single precision is never nearer by more than its rounding, at any scale.
TEST(SampledError, TheNearestTriangleIsFound) {
  std::mt19937 random(7);
  for (const double size : {1.0, 1e-70, 1e-30, 1e30, 1e70}) {
    const std::vector<NewTriangle> triangles = scattered(43, size, random);
    kaboum::geom::Mesh mesh;
    for (const NewTriangle& t : triangles) {
      const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), t.corner.begin(), t.corner.end());
      mesh.triangles.push_back({n, n + 1, n + 2});
    }
    NearestOf nearest(triangles);
    const ClosestTriangle proximity(mesh);
    std::uniform_real_distribution<double> at(-1.5 * size, 1.5 * size);
    std::size_t which = 0;
    std::uint32_t hint = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3 p(at(random), at(random), at(random));
      double least = std::numeric_limits<double>::infinity();
      for (const NewTriangle& t : triangles)
        least = std::min(least, kaboum::bmesh::squared_distance(p, t.corner));
      EXPECT_LE(std::sqrt(nearest.squared(p, which)), std::sqrt(least) + 1e-5 * size);
      EXPECT_LE(std::sqrt(proximity.squared(p, hint)), std::sqrt(least) + 1e-5 * size);
    }
  }
}

// Measuring that stops early knows what it is asked for: whether the largest distance is beyond the
// upper end, and what it is between the ends.
TEST(SampledError, RangesDoNotChangeTheLargestDistance) {
  const auto sphere = kaboum::test::icosphere(2);
  const SampledError deviation(sphere);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> at(-1, 1), radius(0.8, 1.2);
  int zero = 0, between = 0, beyond = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<SampledError::Point> points;
    double largest = 0;
    for (int k = 0; k < 5; ++k) {
      points.push_back({radius(random) * Vec3(at(random), at(random), at(random)).normalized(), 0});
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& t : sphere.triangles)
        nearest = std::min(
            nearest, kaboum::bmesh::squared_distance(
                         points.back().position,
                         {sphere.vertices[t[0]], sphere.vertices[t[1]], sphere.vertices[t[2]]}));
      largest = std::max(largest, nearest);
    }
    std::uint32_t hint = 0;
    const double least = 0.11 * 0.11, most = 0.17 * 0.17;
    const double found = deviation.largest({}, {}, points, hint, {least, most});
    if (largest <= least) {
      ++zero;
      EXPECT_EQ(found, 0);
    } else if (largest <= most) {
      ++between;
      EXPECT_NEAR(found, largest, 1e-12);
    } else {
      ++beyond;
      EXPECT_GT(found, most);
      EXPECT_LE(found, largest * (1 + 1e-12));
    }
  }
  EXPECT_GT(std::min({zero, between, beyond}), 5);
}

TEST(FourTriangles, BitsAreOfThoseBelow) {
  const kaboum::geom::Float4 x{1, -2, 3, 2};
  EXPECT_EQ(kaboum::geom::bits_below(x, 2), 0b0011U);
  EXPECT_EQ(kaboum::geom::bits_below(x, 2.5), 0b1011U);
  EXPECT_EQ(kaboum::geom::bits_below(x, -5), 0U);
  EXPECT_EQ(kaboum::geom::bits_below(x, 5), 0b1111U);
}

}  // namespace
