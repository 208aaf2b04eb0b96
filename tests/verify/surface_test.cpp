// The surface claim by itself, and with an end to the work: the same triangles as the whole verdict
// names, or some of them and a number of those left open, for any number of threads.
#include <gtest/gtest.h>
#include <kaboum/verify/bracket.h>
#include <kaboum/verify/inclusion.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

#include "support/shapes.h"

namespace kaboum::verify {
namespace {

using geom::Mesh;
using geom::Vec3;

/// Random triangles across a cube, every second within its middle, each with its opposite: closed,
/// without any volume.
Mesh sheets(std::uint32_t n) {
  std::mt19937 random(n);
  const auto number = [&] { return static_cast<double>(random()) * 0x1p-32; };
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double x = number(), y = number(), z = number();
      const Vec3 p(x, y, z);
      mesh.vertices.push_back(i % 2 == 0 ? p : Vec3::Constant(0.25) + 0.5 * p);
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    mesh.triangles.push_back({3 * i, 3 * i + 2, 3 * i + 1});
  }
  return mesh;
}

/// Some of the sheets lie in a box, some stick out of it.
struct Pair {
  Mesh inner = sheets(30);
  Mesh outer =
      test::merged({inner, test::translated(test::box({0.8, 0.8, 0.8}, 4), {0.1, 0.1, 0.1})});
};

const Inclusion& whole() {
  static const Inclusion found = verify_inclusion(Pair().inner, Pair().outer);
  return found;
}

InclusionOptions surface_alone(double max_work = std::numeric_limits<double>::infinity()) {
  InclusionOptions options;
  options.surface_only = true;
  options.max_work = max_work;
  return options;
}

TEST(Surface, AloneIsTheSame) {
  const Pair pair;
  for (const std::size_t settle_from : {std::size_t{0}, std::size_t{1000}}) {
    InclusionOptions alone = surface_alone();
    alone.settle_from = settle_from;
    const Inclusion only = verify_inclusion(pair.inner, pair.outer, alone);
    ASSERT_EQ(whole().surface.answer, Answer::Refuted);
    EXPECT_LT(whole().surface.inner_triangles.size(), pair.inner.triangles.size());
    EXPECT_EQ(only.surface.answer, Answer::Refuted);
    EXPECT_EQ(only.surface.inner_triangles, whole().surface.inner_triangles);
    EXPECT_EQ(only.solid.answer, Answer::Undefined);
    EXPECT_EQ(only.left_out, 0U);
    EXPECT_FALSE(only.limited);
  }
  const Mesh sphere = test::icosphere(2);
  EXPECT_EQ(
      verify_inclusion(sphere, test::scaled(sphere, {2, 2, 2}), surface_alone()).surface.answer,
      Answer::Verified);
}

TEST(Surface, EndsWithTheWorkAllowedOnAnyNumberOfThreads) {
  const Pair pair;
  const std::vector<std::uint32_t>& all = whole().surface.inner_triangles;
  for (const double work : {1e-6, 1e-4, 1e-3, 3e-3}) {
    Inclusion first;
    for (const std::size_t threads : {1U, 2U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      Inclusion found = verify_inclusion(pair.inner, pair.outer, surface_alone(work));
      EXPECT_GT(found.left_out, 0U) << work;
      EXPECT_TRUE(found.limited);
      EXPECT_NE(found.surface.answer, Answer::Verified);
      const std::vector<std::uint32_t>& some = found.surface.inner_triangles;
      EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end()));
      EXPECT_LE(some.size() + found.left_out, pair.inner.triangles.size());
      if (threads > 1U) {
        EXPECT_EQ(some, first.surface.inner_triangles);
        EXPECT_EQ(found.left_out, first.left_out);
      }
      first = std::move(found);
    }
  }
}

TEST(Surface, DepthsWithLittleWorkAreBoundsAsWell) {
  const Pair pair;
  const std::vector<std::uint32_t>& all = whole().surface.inner_triangles;
  const Bracket best = bracket_distance(pair.inner, all, pair.outer, true);
  for (const double work : {1e-6, 1e-2, 1e-1}) {
    BracketEffort effort;
    effort.max_work = work;
    const Bracket found = bracket_distance(pair.inner, all, pair.outer, true, effort);
    EXPECT_LE(found.lower, best.upper);
    EXPECT_GE(found.upper, best.lower);
  }
}

}  // namespace
}  // namespace kaboum::verify
