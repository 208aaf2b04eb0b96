// Balls in floats against the same balls in doubles.

#include "balls.h"

#include <gtest/gtest.h>

#include <random>

namespace kaboum::world::detail {
namespace {

TEST(Balls, AreApartOnlyWhereTheyAre) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> from(-1, 1);
  std::size_t apart = 0, wrong = 0, nearly = 0;
  for (const std::size_t count : {1, 7, 8, 9, 63, 64, 65, 150}) {
    for (int trial = 0; trial < 10; ++trial) {
      const double away = trial % 3 == 0 ? 1000 : 0;
      std::vector<geom::Vec3> centers;
      std::vector<double> radii;
      Balls balls(count);
      for (std::size_t i = 0; i < count; ++i) {
        centers.emplace_back(away + from(random), from(random), away + from(random));
        radii.push_back(0.4 * std::abs(from(random)));
        // Every other one touches the one before it.
        if (i % 2 == 1) radii[i] = std::abs((centers[i] - centers[i - 1]).norm() - radii[i - 1]);
        balls.put(i, centers[i], radii[i]);
      }
      for (const bool wide : {false, true}) {
        if (wide && !has_avx2()) continue;
        for (std::size_t i = 0; i < count; ++i) {
          const std::uint64_t* near = balls.look_from(i, wide);
          for (std::size_t j = i + 1; j < count; ++j) {
            const double gap = (centers[i] - centers[j]).norm() - radii[i] - radii[j];
            const bool is_near = (near[j / 64] >> (j % 64) & 1U) != 0;
            wrong += gap < 1e-12 && !is_near ? 1 : 0;
            apart += is_near ? 0 : 1;
            nearly += is_near && gap > 1e-5 * (1 + away) ? 1 : 0;
          }
        }
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(nearly, 0U) << "balls far apart are looked at";
  EXPECT_GT(apart, 10000U);
}

}  // namespace
}  // namespace kaboum::world::detail
