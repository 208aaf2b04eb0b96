#include <gtest/gtest.h>
#include <kaboum/bcd/inner.h>
#include <kaboum/geom/holes.h>
#include <kaboum/io/convex_io.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>

#include "solids.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using geom::Vec3;

/// A solid of revolution round the z axis, from a profile of (radius, height) that begins and ends
/// on the axis, upwards.
Mesh revolved(const std::vector<std::array<double, 2>>& profile, std::uint32_t n) {
  Mesh mesh;
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const bool tip = profile[k][0] == 0;
    for (std::uint32_t i = 0; i < (tip ? 1 : n); ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      mesh.vertices.emplace_back(profile[k][0] * std::cos(angle), profile[k][0] * std::sin(angle),
                                 profile[k][1]);
    }
  }
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size()) - 1;
  const auto rings = static_cast<std::uint32_t>(profile.size()) - 2;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n, top = 1 + (rings - 1) * n;
    mesh.triangles.push_back({0, 1 + j, 1 + i});
    for (std::uint32_t k = 0; k + 1 < rings; ++k) {
      const std::uint32_t a = 1 + k * n;
      mesh.triangles.push_back({a + i, a + j, a + n + j});
      mesh.triangles.push_back({a + i, a + n + j, a + n + i});
    }
    mesh.triangles.push_back({top + i, top + j, last});
  }
  return mesh;
}

/// Triangles all over the unit cube.
Mesh soup(int triangles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 1), offset(-0.2, 0.2);
  Mesh mesh;
  for (int t = 0; t < triangles; ++t) {
    const Vec3 center(place(random), place(random), place(random));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(center + Vec3(offset(random), offset(random), offset(random)));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// A robot's link: a capsule with a flange and a shallow groove.
Mesh link() {
  return revolved({{0, 0},
                   {0.4, 0},
                   {0.5, 0.1},
                   {0.5, 0.5},
                   {0.495, 0.51},
                   {0.495, 0.55},
                   {0.5, 0.56},
                   {0.5, 1.2},
                   {0.4, 1.3},
                   {0, 1.35}},
                  64);
}

TEST(Work, NearlyConvexSolidsAreOneBodyAtOnce) {
  // So little work that no cut is tried.
  for (const Effort effort : {Effort::Fast, Effort::Normal}) {
    const Mesh mesh = geom::prepare(link()).solid.mesh();
    CoverOptions options = test::quick(mesh, 2);
    options.effort = effort;
    options.max_work = 0.5;
    const CoverCandidate result = find_cover(geom::prepare(mesh).solid, options);
    EXPECT_EQ(result.stop, Stop::Done);
    EXPECT_EQ(result.bodies.size(), 1U);
    EXPECT_EQ(result.statistics.leaves, 1U);
    EXPECT_FALSE(result.statistics.out_of_work);
    test::expect_cover(mesh, result, 64);
  }
}

TEST(Work, FansOfThousandsAreOneBody) {
  // A cone, and its base as another fan.
  const Mesh cone = geom::prepare(revolved({{0, 0}, {1, 0}, {0, 1}}, 2500)).solid.mesh();
  CoverOptions options = test::quick(cone, 1);
  options.max_work = 5;
  const CoverCandidate result = find_cover(geom::prepare(cone).solid, options);
  EXPECT_EQ(result.stop, Stop::Done);
  EXPECT_EQ(result.bodies.size(), 1U);
  test::expect_cover(cone, result, 64);
}

TEST(Work, TheBestFoundIsGivenAndMeasuredWhenTheWorkIsDone) {
  const geom::Prepared input = geom::prepare(soup(40));
  const Mesh mesh = geom::fill_holes(input.solid.mesh()).mesh;
  for (const bool limited : {false, true}) {
    CoverOptions options = test::quick(mesh, 0.7);
    options.effort = Effort::Normal;
    options.max_work = 0.3;
    if (limited) {
      options.epsilon.reset();
      options.max_bodies = 60;
    }
    std::vector<std::vector<char>> bytes;
    for (const std::size_t threads : {1U, 2U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const CoverCandidate result = find_cover(input.solid, options);
      EXPECT_TRUE(result.statistics.out_of_work);
      EXPECT_EQ(result.stop, limited ? Stop::Done : Stop::OutOfWork);
      if (limited) {
        EXPECT_LE(result.bodies.size(), 60U);
      } else {
        EXPECT_GT(result.excess_upper, *options.epsilon);
      }
      test::expect_cover(mesh, result, 64);
      bytes.push_back(io::serialise_convex_set(test::set_of(result.bodies), io::SetFormat::Glb));
    }
    EXPECT_EQ(bytes[0], bytes[1]);
  }
}

TEST(Work, FewerBodiesAreLookedForWithinTheWorkThatIsForThat) {
  const Mesh mesh = geom::prepare(kaboum::test::torus_knot(2, 3, 0.2, 60, 8)).solid.mesh();
  std::vector<std::size_t> bodies;
  for (const double seconds : {0.0, 5.0}) {
    CoverOptions options = test::quick(mesh, 2);
    options.effort = Effort::Normal;
    options.improve_work = seconds;
    const CoverCandidate result = find_cover(geom::prepare(mesh).solid, options);
    EXPECT_EQ(result.stop, Stop::Done);  // what epsilon takes is done, whatever it is
    EXPECT_LE(result.excess_upper, *options.epsilon);
    EXPECT_EQ(result.statistics.out_of_work, seconds == 0);
    test::expect_cover(mesh, result, 64);
    bodies.push_back(result.bodies.size());
  }
  EXPECT_LT(bodies[1], bodies[0]);
}

TEST(Work, BodiesInsideEndToo) {
  const Mesh mesh = geom::prepare(kaboum::test::torus_knot(2, 3, 0.2, 60, 8)).solid.mesh();
  InnerOptions options = test::quick_inner(mesh, 0.05);
  options.max_work = 0.1;
  const InnerCandidate result = find_inner(geom::prepare(mesh).solid, options);
  EXPECT_EQ(result.stop, Stop::OutOfWork);
  EXPECT_TRUE(result.out_of_work);
  EXPECT_GT(result.uncovered_depth_upper, *options.epsilon);
  EXPECT_LT(result.uncovered_depth_lower, result.uncovered_depth_upper);
  test::expect_bodies(result.bodies, 64);
}

TEST(Work, NothingIsNoWork) {
  const Mesh mesh = geom::prepare(link()).solid.mesh();
  CoverOptions options = test::quick(mesh, 1);
  options.max_work = 0;
  EXPECT_THROW(find_cover(geom::prepare(mesh).solid, options), Error);
  EXPECT_EQ(default_work(100), default_work(10000));
  EXPECT_GT(default_work(20000), default_work(10000));
}

}  // namespace
}  // namespace kaboum::bcd
