/// Clusters of triangles and cuts between voxels, which benchmarks/ compares with: their bodies
/// cover the solid, too.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/io/convex_io.h>
#include <tbb/global_control.h>

#include <array>
#include <set>

#include "decomposition/clusters.h"
#include "decomposition/compared_methods.h"
#include "decomposition/voxel_cuts.h"
#include "solids.h"

namespace kaboum::bcd {
namespace {

constexpr std::array<ComparedMethod, 2> kMethods{ComparedMethod::Clusters, ComparedMethod::Voxels};

CoverOptions at_most(std::size_t bodies) {
  CoverOptions options;
  options.effort = Effort::Fast;
  options.max_bodies = bodies;
  return options;
}

Mesh letter() { return test::prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1); }

TEST(ComparedMethods, CoverWithSoManyBodiesOrSaySo) {
  int done = 0, seen = 0, families = 0;
  test::for_each_solid(300, [&](const auto&, const geom::Prepared& prepared) {
    if (families++ % 2 != 0) return;
    const ComparedMethod method = kMethods.at(static_cast<std::size_t>(seen++ % 2));
    const CoverCandidate result = find_cover_by(method, prepared.solid, at_most(6));
    if (result.stop == Stop::TooCoarse) return;
    test::expect_cover(prepared.solid.mesh(), result, 64);
    EXPECT_EQ(result.stop == Stop::Done, result.bodies.size() <= 6);
    done += result.stop == Stop::Done ? 1 : 0;
  });
  EXPECT_GE(seen, 4);
  EXPECT_GE(done, seen - 1);
}

TEST(ComparedMethods, AtMostSoManyBodies) {
  const Mesh torus = kaboum::test::torus(1, 0.3, 40, 16);
  const geom::Prepared input = geom::prepare(torus);
  for (const ComparedMethod method : kMethods) {
    const CoverCandidate result = find_cover_by(method, input.solid, at_most(8));
    EXPECT_LE(result.bodies.size(), 8U);
    EXPECT_GE(result.bodies.size(), 3U);
    EXPECT_LE(result.excess_upper, 0.2 * geom::bounding_box(torus).diagonal());
    test::expect_cover(input.solid.mesh(), result, 64);
  }
}

TEST(ComparedMethods, ALetterInTwo) {
  const geom::Prepared input = geom::prepare(letter());
  for (const ComparedMethod method : kMethods) {
    const CoverCandidate result = find_cover_by(method, input.solid, at_most(2));
    EXPECT_EQ(result.bodies.size(), 2U);
    EXPECT_LE(result.excess_upper, 0.03 * geom::bounding_box(input.solid.mesh()).diagonal());
    test::expect_cover(input.solid.mesh(), result, 64);
  }
}

TEST(ComparedMethods, SimplifyTheInputFirstOnRequest) {
  // Two finely meshed boxes, 2 apart.
  const Mesh mesh = kaboum::test::merged(
      {kaboum::test::box(Vec3(1, 2, 3), 12),
       kaboum::test::translated(kaboum::test::box(Vec3(1, 2, 3), 12), Vec3(3, 0, 0))});
  const geom::Prepared input = geom::prepare(mesh);
  CoverOptions options = at_most(1);
  options.pre_step = PreStep::On;
  for (const ComparedMethod method : kMethods) {
    const CoverCandidate result = find_cover_by(method, input.solid, options);
    EXPECT_GT(result.statistics.pre_step_triangles, 0U);
    EXPECT_LT(2 * result.statistics.pre_step_triangles, mesh.triangles.size());
    EXPECT_EQ(result.bodies.size(), 1U);
    EXPECT_GE(result.excess_upper, 1);  // between them
    EXPECT_LT(result.excess_upper, 1.1);
    test::expect_cover(input.solid.mesh(), result, 64);
  }
}

TEST(ComparedMethods, OtherLimitsAreRefused) {
  const geom::Prepared input = geom::prepare(letter());
  CoverOptions both = at_most(2), none = at_most(2), total = at_most(2), thick = at_most(2);
  both.epsilon = 0.1;
  none.max_bodies.reset();
  total.max_total_vertices = 30;
  thick.min_thickness = 0.1;
  for (const CoverOptions& options : {both, none, total, thick})
    EXPECT_THROW(find_cover_by(ComparedMethod::Voxels, input.solid, options), Error);
}

TEST(ComparedMethods, SameBytesForAnyNumberOfThreads) {
  const Mesh mesh = kaboum::test::torus(1, 0.3, 24, 10);
  for (const ComparedMethod method : kMethods) {
    std::vector<std::vector<char>> bytes;
    for (const std::size_t threads : {1U, 3U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const CoverCandidate result = find_cover_by(method, geom::prepare(mesh).solid, at_most(8));
      bytes.push_back(io::serialise_convex_set(test::set_of(result.bodies), io::SetFormat::Glb));
    }
    EXPECT_EQ(bytes[0], bytes[1]);
  }
}

TEST(VoxelCuts, TheLetterIsCutAtItsEdge) {
  const Mesh mesh = letter();
  const SolidField solid(mesh, 5000, 0);
  const VoxelCuts cuts(solid, 20000);
  const Cell cell = Cell::of({Vec3::Constant(-1), Vec3::Constant(4)});
  const auto plane = cuts.choose(cell, mesh.vertices);
  ASSERT_TRUE(plane.has_value());
  int axis = 0;
  EXPECT_EQ(plane->n.cwiseAbs().maxCoeff(&axis), 1);
  EXPECT_LT(axis, 2);
  EXPECT_NEAR(plane->d, 1, 0.1);  // a voxel or two
  // Too small to be cut, and smaller than a voxel.
  EXPECT_FALSE(cuts.choose(cell, {Vec3(1, 1, 0.5)}).has_value());
  const auto halved = cuts.choose(cell, {Vec3(0.5, 0.5, 0.5), Vec3(0.501, 0.5, 0.5)});
  ASSERT_TRUE(halved.has_value());
  EXPECT_NEAR(halved->d, 0.5005, 1e-9);
}

TEST(Clusters, ConvexPartsBecomeOneEach) {
  const Mesh two = kaboum::test::merged(
      {kaboum::test::icosphere(2),
       kaboum::test::translated(kaboum::test::box(Vec3(1, 2, 3), 4), Vec3(5, 0, 0))});
  const SolidField solid(two, 20000, 0);
  for (const double epsilon : {0.05, std::numeric_limits<double>::infinity()}) {
    const std::vector<std::uint32_t> label = cluster_triangles(solid, 1, epsilon);
    const std::set<std::uint32_t> different(label.begin(), label.end());
    EXPECT_EQ(different.size(), 2U);
    EXPECT_NE(label.front(), label.back());
  }
  EXPECT_EQ(cluster_triangles(solid, two.triangles.size(), 1).size(), two.triangles.size());
}

/// Whatever the clusters are, every leaf goes to one body.
TEST(Clusters, EveryLeafIsInABody) {
  const Mesh mesh = kaboum::test::icosphere(2);
  const SolidField solid(mesh, 20000, 0);
  CutTree tree(solid, {});
  while (tree.leaf_count() < 20 && tree.cut_worst()) {
  }
  std::vector<std::uint32_t> label(mesh.triangles.size());
  for (std::uint32_t t = 0; t < label.size(); ++t) label[t] = t % 5;
  std::vector<int> leaves;
  for (const Body& body : bodies_of_clusters(tree, solid, label))
    leaves.insert(leaves.end(), body.leaves.begin(), body.leaves.end());
  std::sort(leaves.begin(), leaves.end());
  EXPECT_EQ(leaves, tree.leaves());
}

}  // namespace
}  // namespace kaboum::bcd
