// Steps against the original are taken several at a time, by any number of threads.
#include "optimise_in_parallel.h"

#include <kaboum/geom/topology.h>
#include <kaboum/verify/replay.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>

#include "recorded.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT
using verify::replay;

test::Recorded run(Direction direction, Cost cost, std::size_t threads, double share = 0.1) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  DecimateOptions o;
  o.direction = direction;
  o.cost = cost;
  o.effort = Effort::Normal;
  // Large enough not to be decimated within an error bound.
  return test::record(test::noisy(test::torus(1, 0.4, 90, 46), 3e-3, 3), o, share);
}

TEST(ParallelOptimiser, GivesTheSameForAnyNumberOfThreads) {
  for (const auto& [direction, cost] :
       {std::pair(Direction::Outer, Cost::Distance), std::pair(Direction::Inner, Cost::Distance),
        std::pair(Direction::Outer, Cost::Mean)}) {
    const test::Recorded one = run(direction, cost, 1);
    EXPECT_GT(one.result.statistics.pull_backs, 100U);
    const auto checked = replay(one.input, one.log, one.result.mesh);
    EXPECT_TRUE(checked.verified) << checked.violation;
    test::expect_same(one, run(direction, cost, 5));
  }
}

/// Boxes of which each meets the next one at an edge, and a series of them.
std::vector<DecimateResult> series(Direction direction, std::size_t threads, bool open) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const geom::Mesh box = test::box({1, 1, 1}, 12);
  std::vector<geom::Mesh> boxes;
  for (int i = 0; i < 3; ++i) boxes.push_back(test::translated(box, {1.0 * i, 1.0 * i, 0}));
  geom::Mesh mesh = test::welded(test::merged(boxes));
  for (geom::Vec3& v : mesh.vertices)
    v.z() += 0.02 * std::sin(9 * v.x()) * std::sin(7 * v.y()) * (2 * v.z() - 1);
  if (open) mesh = test::without(mesh, [](const geom::Vec3& p) { return p.x() > 2.7; });
  const auto p = geom::prepare(mesh);
  DecimateOptions o;
  o.direction = direction;
  o.cost = Cost::Distance;
  o.effort = Effort::Best;
  o.precision = Precision::Float;
  return decimate_series(p.solid, o, std::vector<std::size_t>{600, 300, 150});
}

TEST(ParallelOptimiser, GivesTheSameSeriesForAnyNumberOfThreads) {
  for (const auto& [direction, open] :
       {std::pair(Direction::Outer, false), std::pair(Direction::Any, true)}) {
    const auto one = series(direction, 1, open), other = series(direction, 5, open);
    EXPECT_GT(one.back().statistics.pull_backs, 20U);
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].mesh.triangles, other[i].mesh.triangles);
      EXPECT_EQ(one[i].mesh.vertices, other[i].mesh.vertices);
      EXPECT_EQ(one[i].statistics.predicates, other[i].statistics.predicates);
    }
  }
}

// A task of the caller's own throws, which ends the caller's loop, but not what goes on within.
TEST(ParallelOptimiser, IsDoneThoughTheCallersGroupIsCancelled) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
  std::atomic<bool> under_way = false, thrown = false;
  std::optional<test::Recorded> r;
  DecimateOptions o;
  o.cost = Cost::Distance;
  o.effort = Effort::Normal;
  o.progress = [&](std::size_t) { under_way = true; };
  EXPECT_THROW(tbb::parallel_for(
                   0, 2,
                   [&](int task) {
                     if (task == 1) {
                       while (!under_way) std::this_thread::yield();
                       thrown = true;
                       throw std::runtime_error("sibling");
                     }
                     r = test::record(test::noisy(test::torus(1, 0.4, 90, 46), 3e-3, 3), o, 0.14);
                     EXPECT_TRUE(thrown);
                   },
                   tbb::simple_partitioner()),
               std::runtime_error);
  ASSERT_TRUE(r);
  EXPECT_EQ(r->result.mesh.vertices,
            run(Direction::Outer, Cost::Distance, 2, 0.14).result.mesh.vertices);
  const auto checked = replay(r->input, r->log, r->result.mesh);
  EXPECT_TRUE(checked.verified) << checked.violation;
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
  const geom::Mesh& sphere = p.solid.mesh();
  WorkingMesh mesh(p.solid);
  SampledError deviation(sphere);
  ReferenceSolid solid(sphere);
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
                                  nullptr, false);
      ASSERT_TRUE(optimiser.claim({first[0], first[1]}));
      ASSERT_EQ(optimiser.claim({second[1], second[2]}), !meet);
      ++(meet ? together : apart);
    }
  }
  EXPECT_GT(together, 100U);
  EXPECT_GT(apart, 100U);
}

}  // namespace
