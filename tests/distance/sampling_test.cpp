#include <kaboum/distance/sampling.h>
#include <kaboum/distance/search.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "support/shapes.h"

namespace {

using kaboum::distance::sample_distances;
using kaboum::geom::DistanceQuery;
using kaboum::geom::Mesh;

// Square z = x over the unit square, against the plane z = 0: the mean distance is 1/2, its root
// mean square √(1/3).
TEST(Sampling, MeetsKnownMeans) {
  const Mesh a = kaboum::test::grid(4, [](double x, double) { return x; });
  const Mesh b{{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const DistanceQuery query(b);
  int far = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto s = sample_distances(a, query, 1000, seed);
    EXPECT_EQ(s.samples, 1000U);
    far += std::abs(s.mean.value - 0.5) > 2 * s.mean.standard_error;
    far += std::abs(s.rms.value - std::sqrt(1.0 / 3)) > 2 * s.rms.standard_error;
    EXPECT_NEAR(s.mean.value, 0.5, 5 * s.mean.standard_error);
    EXPECT_NEAR(s.rms.value, std::sqrt(1.0 / 3), 5 * s.rms.standard_error);
    // Plain sampling would have 0.2887/√1000 = 0.0091.
    EXPECT_LT(s.mean.standard_error, 0.007);
    EXPECT_GT(s.mean.standard_error, 1e-4);
  }
  // About one in twenty beyond two standard errors.
  EXPECT_LE(far, 14);
}

TEST(Sampling, DependsOnTheSeedAndNotOnThreads) {
  const Mesh a = kaboum::test::icosphere(2);
  const DistanceQuery query(kaboum::test::box({1, 1, 1}, 1));
  const auto many = sample_distances(a, query, 5000, 7);
  const auto other = sample_distances(a, query, 5000, 8);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = sample_distances(a, query, 5000, 7);
  EXPECT_EQ(many.mean.value, single.mean.value);
  EXPECT_EQ(many.rms.standard_error, single.rms.standard_error);
  EXPECT_NE(many.mean.value, other.mean.value);
}

TEST(Sampling, TakesSurfacesWithoutArea) {
  const Mesh a{{{0, 0, 1}, {1, 0, 1}}, {{0, 1, 1}}};
  const Mesh b{{{-5, -5, 0}, {5, -5, 0}, {0, 5, 0}}, {{0, 1, 2}}};
  const auto s = sample_distances(a, DistanceQuery(b), 100, 1);
  EXPECT_NEAR(s.mean.value, 1, 1e-12);
}

}  // namespace
