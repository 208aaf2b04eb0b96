// Large meshes are contracted region by region: what comes of it is the same for any number of
// threads, certified like everything else, and in order.
#include "regions.h"

#include <kaboum/geom/topology.h>
#include <kaboum/verify/replay.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "recorded.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT
using verify::replay;

geom::Mesh closed_mesh() { return test::noisy(test::torus(1, 0.4, 160, 64), 1e-3, 3); }

/// Two parts without a common vertex, through each other.
geom::Mesh crossing_mesh() {
  return test::merged({test::noisy(test::icosphere(5), 1e-3, 5),
                       test::translated(test::noisy(test::icosphere(4), 1e-3, 6), {1.5, 0, 0})});
}

geom::Mesh open_mesh() {
  return test::grid(100,
                    [](double x, double y) { return 0.1 * std::sin(9 * x) * std::cos(7 * y); });
}

test::Recorded run(const geom::Mesh& mesh, Direction direction, Cost cost = Cost::Planes,
                   std::size_t threads = 0) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, threads);
  DecimateOptions o;
  o.direction = direction;
  o.cost = cost;
  return test::record(mesh, o, 0.04);
}

// Across the tube of the torus, far from what the step may do.
TEST(Regions, StepsAcrossTheSurfaceAreRefuted) {
  std::mt19937_64 random(12);
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    const test::Recorded r = run(closed_mesh(), d);
    for (int i = 0; i < 20; ++i) {
      Log mutant = r.log;
      geom::Vec3& place = mutant.steps[random() % (mutant.steps.size() / 2)].position;
      const geom::Vec3 middle = geom::Vec3(place.x(), place.y(), 0).normalized();
      place += (d == Direction::Outer ? -0.3 : 0.3) * (place - middle);
      const auto checked = replay(r.input, mutant, r.result.mesh);
      EXPECT_FALSE(checked.verified);
      EXPECT_NE(checked.violation.find("step"), std::string::npos) << checked.violation;
    }
  }
}

/// The stage alone.
struct Reduced {
  explicit Reduced(const geom::Mesh& mesh, std::size_t target, Direction direction)
      : input(geom::prepare(mesh).solid), before(input.mesh(), input.border(), {}), after(before) {
    options.direction = direction;
    const Context context(input.mesh(), input.closed(), options);
    before.quadric = context.cost.initial(input.mesh());
    after = before;
    contract_in_regions(context, after, target, nullptr, &steps, statistics);
  }
  DecimateOptions options;
  geom::SolidMesh input;
  PartialMesh before, after;
  std::vector<Step> steps;
  DecimateStatistics statistics;
};

TEST(Regions, AreTheSameForAnyNumberOfThreads) {
  for (const auto& [mesh, direction, cost] :
       {std::tuple(closed_mesh(), Direction::Outer, Cost::Planes),
        std::tuple(crossing_mesh(), Direction::Outer, Cost::Distance),
        std::tuple(closed_mesh(), Direction::Inner, Cost::Distance)}) {
    const test::Recorded one = run(mesh, direction, cost, 1);
    for (const std::size_t threads : {2, 5})
      test::expect_same(one, run(mesh, direction, cost, threads));
  }
}

TEST(Regions, StepsAreReplayed) {
  for (const geom::Mesh& mesh : {closed_mesh(), crossing_mesh(), open_mesh()}) {
    for (const Direction d : {Direction::Outer, Direction::Inner}) {
      const test::Recorded r = run(mesh, d);
      EXPECT_LT(r.result.mesh.vertices.size(), mesh.vertices.size() / 5);
      const auto checked = replay(r.input, r.log, r.result.mesh);
      EXPECT_TRUE(checked.verified) << checked.violation;
      EXPECT_EQ(
          r.result.statistics.contractions + r.result.statistics.moves + r.result.statistics.flips,
          r.log.steps.size());
      Log turned = r.log;
      turned.direction = d == Direction::Outer ? Direction::Inner : Direction::Outer;
      EXPECT_FALSE(replay(r.input, turned, r.result.mesh).verified);
    }
  }
}

std::set<std::array<double, 3>> border_places(const std::vector<geom::Vec3>& position,
                                              const std::vector<char>& border) {
  std::set<std::array<double, 3>> places;
  for (std::size_t v = 0; v < border.size(); ++v)
    if (border[v] != 0) places.insert({position[v].x(), position[v].y(), position[v].z()});
  return places;
}

TEST(Regions, LeaveAMeshInOrder) {
  for (const geom::Mesh& mesh : {closed_mesh(), crossing_mesh(), open_mesh()}) {
    const std::size_t target = 1000;
    const Reduced r(mesh, target, Direction::Outer);
    const PartialMesh& m = r.after;
    EXPECT_LT(10 * m.position.size(), 6 * r.before.position.size());
    EXPECT_GE(m.position.size(), target);
    EXPECT_EQ(r.before.position.size() - m.position.size(), r.steps.size());
    EXPECT_EQ(r.statistics.contractions, r.steps.size());
    ASSERT_EQ(m.border.size(), m.position.size());
    ASSERT_EQ(m.quadric.size(), m.position.size());
    ASSERT_EQ(m.vertex.size(), m.position.size());
    ASSERT_EQ(m.triangle.size(), m.triangles.size());
    // Nothing stays locked, borders stay where they are, numbers are of different input vertices.
    for (const char b : m.border) EXPECT_LE(b, 1);
    EXPECT_EQ(border_places(m.position, m.border),
              border_places(r.input.mesh().vertices, r.input.border()));
    EXPECT_EQ(std::set<std::uint32_t>(m.vertex.begin(), m.vertex.end()).size(), m.vertex.size());
    EXPECT_TRUE(std::is_sorted(m.triangle.begin(), m.triangle.end(), std::less_equal<>()));
    geom::Mesh left{m.position, m.triangles};
    geom::require_valid(left);
    EXPECT_EQ(geom::analyse(left).closed(), r.input.closed());
    EXPECT_EQ(geom::analyse(left).nonmanifold_edges, 0U);
    // The steps lead to just this mesh.
    Log log = test::log_of_preparation(mesh, geom::prepare(mesh), Direction::Outer);
    log.steps = r.steps;
    const auto checked = replay(mesh, log, left);
    EXPECT_TRUE(checked.verified) << checked.violation;
  }
}

// Quadrics are carried along: each is the sum of those of the vertices that were contracted into
// it.
TEST(Regions, CarryTheQuadrics) {
  const Reduced r(closed_mesh(), 1000, Direction::Outer);
  double before = 0, after = 0;
  for (const Quadric& q : r.before.quadric) before += q.trace();
  for (const Quadric& q : r.after.quadric) after += q.trace();
  EXPECT_NEAR(after, before, 1e-9 * before);
}

TEST(Regions, LeaveSmallMeshesAlone) {
  const Reduced r(test::icosphere(4), 100, Direction::Outer);
  EXPECT_TRUE(r.steps.empty());
  EXPECT_EQ(r.after.position, r.before.position);
  EXPECT_EQ(r.after.triangles, r.before.triangles);
}

}  // namespace
