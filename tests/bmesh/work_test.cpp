// Inputs that would take long: an end to them, the same on any number of threads, with a result
// that encloses as ever.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/verify/replay.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "recorded.h"
#include "support/shapes.h"

namespace kaboum::bmesh {
namespace {
using verify::replay;
using verify::ReplayResult;

using geom::Mesh;

/// A cone of n sides, and its base as another fan.
Mesh double_fan(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  mesh.vertices.emplace_back(0, 0, 1);
  mesh.vertices.emplace_back(0, 0, -1);
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.triangles.push_back({n, i, (i + 1) % n});
    mesh.triangles.push_back({n + 1, (i + 1) % n, i});
  }
  return mesh;
}

DecimateOptions as_the_tool_does() {
  DecimateOptions options;
  options.cost = Cost::Distance;
  options.effort = Effort::Normal;
  return options;
}

/// With the same steps for one and two threads.
test::Recorded record_twice(const Mesh& mesh, const DecimateOptions& options, double share) {
  std::optional<test::Recorded> first;
  for (const std::size_t threads : {1U, 2U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    test::Recorded r = test::record(mesh, options, share);
    if (first) {
      test::expect_same(*first, r);
      EXPECT_EQ(first->result.out_of_work, r.result.out_of_work);
    } else {
      first = std::move(r);
    }
  }
  const ReplayResult replayed = replay(first->input, first->log, first->result.mesh);
  EXPECT_TRUE(replayed.verified) << replayed.violation;
  return std::move(*first);
}

TEST(Work, FansOfThousandsEnd) {
  DecimateOptions options = as_the_tool_does();
  options.max_work = 0.2;
  const test::Recorded r = record_twice(double_fan(1500), options, 0.25);
  EXPECT_TRUE(r.result.out_of_work);
  EXPECT_LT(r.result.mesh.vertices.size(), r.result.statistics.vertices_in);
}

TEST(Work, TheBestSoFarIsGivenWhenItIsDone) {
  const Mesh sphere = test::icosphere(4);
  DecimateOptions options = as_the_tool_does();
  options.max_work = 0.002;
  const test::Recorded cut = record_twice(sphere, options, 0.1);
  EXPECT_EQ(cut.result.stop, Stop::OutOfWork);
  EXPECT_TRUE(cut.result.out_of_work);
  EXPECT_GT(10 * cut.result.mesh.vertices.size(), cut.result.statistics.vertices_in);
  // What is expensive ends earlier, so that the number is reached.
  options.max_work = 0.3;
  const test::Recorded hurried = record_twice(sphere, options, 0.1);
  EXPECT_EQ(hurried.result.stop, Stop::VertexTarget);
  EXPECT_TRUE(hurried.result.out_of_work);
}

TEST(Work, WithinAnErrorBoundToo) {
  DecimateOptions options = as_the_tool_does();
  options.epsilon = 0.02;
  options.max_work = 0.02;
  const test::Recorded r = record_twice(test::icosphere(4), options, 0);
  EXPECT_TRUE(r.result.out_of_work);
  EXPECT_LE(geom::directed_distance(r.input, geom::DistanceQuery(r.result.mesh)).max_lower, 0.02);
  EXPECT_LE(geom::directed_distance(r.result.mesh, geom::DistanceQuery(r.input)).max_lower, 0.02);
}

TEST(Work, EnoughLeavesNoTrace) {
  const test::Recorded r = test::record(test::icosphere(2), as_the_tool_does(), 0.5);
  EXPECT_FALSE(r.result.out_of_work);
}

TEST(Work, MustBePositive) {
  DecimateOptions options = as_the_tool_does();
  options.max_work = 0;
  EXPECT_THROW(test::record(test::icosphere(1), options, 0.5), Error);
}

// Holes of single triangles are filled by their opposites: a contraction would leave nothing of
// them.
TEST(Work, SheetsOfTwoTrianglesStay) {
  Mesh sheets;
  for (std::uint32_t i = 0; i < 3; ++i) {
    for (const geom::Vec3& p : {geom::Vec3(0, 0, i), geom::Vec3(1, 0, i), geom::Vec3(0, 1, i)})
      sheets.vertices.push_back(p);
    sheets.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  geom::PrepareOptions fill;
  fill.holes = geom::Holes::Fill;
  DecimateOptions options = as_the_tool_does();
  options.vertices = 4;
  const DecimateResult result = decimate(geom::prepare(sheets, fill).solid, options);
  EXPECT_EQ(result.mesh.triangles.size(), 6U);
}

}  // namespace
}  // namespace kaboum::bmesh
