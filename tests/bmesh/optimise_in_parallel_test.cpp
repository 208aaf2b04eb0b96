// Steps against the original are taken several at a time, by any number of threads.
#include "optimise_in_parallel.h"

#include <kaboum/bmesh/replay.h>
#include <kaboum/geom/topology.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <set>

#include "recorded.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT

test::Recorded run(Direction direction, Cost cost, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  DecimateOptions o;
  o.direction = direction;
  o.cost = cost;
  o.effort = Effort::Normal;
  // Large enough not to be decimated within an error bound.
  return test::record(test::noisy(test::torus(1, 0.4, 90, 46), 3e-3, 3), o, 0.1);
}

TEST(ParallelOptimiser, GivesTheSameForAnyNumberOfThreads) {
  for (const auto& [direction, cost] :
       {std::pair(Direction::Outer, Cost::Distance), std::pair(Direction::Inner, Cost::Distance),
        std::pair(Direction::Outer, Cost::Mean)}) {
    const test::Recorded one = run(direction, cost, 1);
    EXPECT_GT(one.result.statistics.pull_backs, 100U);
    const auto checked = replay(one.input, one.log, one.result.mesh);
    EXPECT_TRUE(checked.verified) << checked.violation;
    for (const std::size_t threads : {2, 5}) {
      const test::Recorded other = run(direction, cost, threads);
      EXPECT_EQ(one.result.mesh.triangles, other.result.mesh.triangles);
      EXPECT_EQ(one.result.mesh.vertices, other.result.mesh.vertices);
      ASSERT_EQ(one.log.steps.size(), other.log.steps.size());
      for (std::size_t i = 0; i < one.log.steps.size(); ++i) {
        EXPECT_EQ(one.log.steps[i].kept, other.log.steps[i].kept);
        EXPECT_EQ(one.log.steps[i].gone, other.log.steps[i].gone);
        EXPECT_EQ(one.log.steps[i].position, other.log.steps[i].position);
      }
      EXPECT_EQ(one.result.statistics.predicates, other.result.statistics.predicates);
      EXPECT_EQ(one.result.statistics.pull_backs, other.result.statistics.pull_backs);
      EXPECT_EQ(one.result.statistics.rejected_original, other.result.statistics.rejected_original);
    }
  }
}

/// Vertices that contracting an edge may move: its ends and their neighbours.
std::set<std::uint32_t> moved(const geom::Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  std::set<std::uint32_t> all;
  for (const geom::Triangle& t : mesh.triangles)
    if (std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return v == a || v == b; }))
      all.insert(t.begin(), t.end());
  return all;
}

// Two edges share a batch just when no triangle has a vertex that either moves.
TEST(ParallelOptimiser, EdgesOfABatchAreApart) {
  const auto p = geom::prepare(test::icosphere(2));
  const geom::Mesh& sphere = p.mesh;
  WorkingMesh mesh(p);
  Deviation deviation(sphere);
  OriginalSolid solid(sphere);
  DecimateOptions options;
  DecimateStatistics statistics;
  deviation.assign(mesh.position, mesh.mesh);
  std::size_t together = 0, apart = 0;
  for (const geom::Triangle& first : sphere.triangles) {
    if (first[0] % 7 != 0) continue;
    const auto moved_first = moved(sphere, first[0], first[1]);
    for (const geom::Triangle& second : sphere.triangles) {
      const auto moved_second = moved(sphere, second[1], second[2]);
      const bool meet = std::any_of(
          sphere.triangles.begin(), sphere.triangles.end(), [&](const geom::Triangle& t) {
            const auto in = [&](const std::set<std::uint32_t>& of) {
              return std::any_of(t.begin(), t.end(), [&](auto v) { return of.contains(v); });
            };
            return in(moved_first) && in(moved_second);
          });
      ParallelOptimiser optimiser(mesh, deviation, &solid, sphere, nullptr, options, statistics,
                                  false);
      ASSERT_TRUE(optimiser.claim({first[0], first[1]}));
      ASSERT_EQ(optimiser.claim({second[1], second[2]}), !meet);
      ++(meet ? together : apart);
    }
  }
  EXPECT_GT(together, 100U);
  EXPECT_GT(apart, 100U);
}

}  // namespace
