#include <kaboum/geom/spatial_order.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace {

using namespace kaboum;  // NOLINT: the test uses most of it

std::vector<geom::Vec3> cloud(std::size_t n) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> at(-5, 7);
  std::vector<geom::Vec3> points;
  for (std::size_t i = 0; i < n; ++i) points.emplace_back(at(random), at(random), at(random));
  return points;
}

double mean_step(const std::vector<geom::Vec3>& points, const std::vector<std::uint32_t>& order) {
  double sum = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    sum += (points[order[i]] - points[order[i - 1]]).norm();
  return sum / static_cast<double>(order.size());
}

TEST(SpatialOrder, IsAPermutationThatKeepsNeighboursTogether) {
  const auto points = cloud(5000);
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0U);
  const double as_given = mean_step(points, all);
  std::vector<std::uint32_t> last;
  for (const double shift : {0.0, 0.38, 1.0}) {
    auto order = geom::spatial_order(points, shift);
    EXPECT_LT(mean_step(points, order), 0.15 * as_given);
    EXPECT_NE(order, last);
    last = order;
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, all);
  }
}

TEST(SpatialOrder, KeepsEqualPlacesInOrder) {
  const std::vector<geom::Vec3> points(100, geom::Vec3(1, 2, 3));
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(geom::spatial_order(points, 0.3), all);
  EXPECT_TRUE(geom::spatial_order(std::vector<geom::Vec3>{}, 0).empty());
}

}  // namespace
