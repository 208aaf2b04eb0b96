// The farthest points in floats, by vectors of four and of eight, against a loop.

#include "farthest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace kaboum::collide::detail {
namespace {

using Direction = std::array<float, 3>;

float product(const Direction& d, const Direction& p) {
  return d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
}

struct Points {
  std::vector<Direction> points;
  std::vector<float> rows;  ///< as farthest_of takes them
};

Points random_points(std::mt19937_64& random, std::size_t count) {
  // Whole numbers: many products are equal.
  std::uniform_int_distribution<int> whole(-3, 3);
  std::uniform_real_distribution<float> from(-1, 1);
  const bool coarse = random() % 2 == 0;
  Points out;
  for (std::size_t i = 0; i < count; ++i) {
    Direction p;
    for (float& x : p) x = coarse ? static_cast<float>(whole(random)) : from(random);
    out.points.push_back(p);
  }
  for (std::size_t i = 0; i < count; i += kFloatsAtOnce)
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t k = i; k < i + kFloatsAtOnce; ++k)
        out.rows.push_back(out.points[std::min(k, count - 1)][axis]);
  return out;
}

void expect_farthest(const Farthest& found, const Points& points, const Direction& d) {
  float most = product(d, points.points[0]);
  for (const Direction& p : points.points) most = std::max(most, product(d, p));
  EXPECT_EQ(found.product, most);
  const std::size_t index = std::min<std::size_t>(found.index, points.points.size() - 1);
  EXPECT_EQ(product(d, points.points[index]), most);
}

TEST(Farthest, IsFoundByFoursAndByEights) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> from(-1, 1);
  for (std::size_t count = 1; count < 70; ++count) {
    for (int trial = 0; trial < 20; ++trial) {
      const Points a = random_points(random, count), b = random_points(random, 1 + random() % 40);
      Direction d{from(random), from(random), from(random)};
      if (trial % 4 == 0) d = {0, 0, trial % 8 == 0 ? 1.0F : 0.0F};
      const Direction e{-d[1], d[2], d[0]};
      for (const bool wide : {false, true}) {
        if (wide && !has_avx2()) continue;
        const FarthestPair found = farthest_of(a.rows, d, b.rows, e, wide);
        expect_farthest(found.a, a, d);
        expect_farthest(found.b, b, e);
      }
    }
  }
}

}  // namespace
}  // namespace kaboum::collide::detail
