#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/geom/holes.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/mesh_io.h>
#include <tbb/global_control.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "body_bound.h"
#include "decomposer.h"
#include "part.h"
#include "solid_field.h"
#include "solids.h"
#include "support/families.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using geom::Vec3;
using test::cover_of;
using test::expect_cover;
using test::prism;
using test::set_of;

CoverCandidate run(const Mesh& mesh, double epsilon_percent, std::size_t max_vertices = 64) {
  return find_cover(geom::prepare(mesh).solid, test::quick(mesh, epsilon_percent, max_vertices));
}

TEST(Cover, CoversEveryFamily) {
  int seen = 0;
  test::for_each_solid(1500, [&](const kaboum::test::Family& f, const geom::Prepared& prepared) {
    const std::size_t most = seen % 2 == 0 ? 64 : 24;
    const CoverCandidate result = run(prepared.solid.mesh(), 4, most);
    if (result.stop == Stop::TooCoarse) {
      EXPECT_TRUE(result.bodies.empty());
      return;
    }
    expect_cover(prepared.solid.mesh(), result, most);
    if (f.convex && f.mesh.vertices.size() <= most) {
      EXPECT_EQ(result.bodies.size(), 1U);
    }
    ++seen;
  });
  EXPECT_GE(seen, 10);
}

TEST(Cover, CoversOpenMeshesAndTheirFilledHoles) {
  int seen = 0;
  for (const auto& f : kaboum::test::open_families()) {
    if (f.mesh.triangles.size() > 1500) continue;
    SCOPED_TRACE(f.name);
    geom::Prepared prepared;
    try {
      prepared = geom::prepare(f.mesh);
    } catch (const Error&) {
      continue;
    }
    const CoverCandidate result = run(prepared.solid.mesh(), 5);
    if (result.stop == Stop::TooCoarse) continue;
    expect_cover(geom::fill_holes(prepared.solid.mesh()).mesh, result, 64);
    ++seen;
  }
  EXPECT_GE(seen, 2);
}

TEST(Cover, PointsOfTheSolidAreInABody) {
  const Mesh knot = geom::prepare(kaboum::test::torus_knot(2, 3, 0.2, 40, 6)).solid.mesh();
  const CoverCandidate result = run(knot, 3);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  int inside = 0;
  for (int i = 0; i < 800; ++i) {
    const Vec3 p(unit(random), unit(random), 0.5 * unit(random));
    const auto w = kaboum::test::winding_number_slow(knot, p);
    if (w && *w < 1) continue;
    ++inside;
    EXPECT_TRUE(test::covered(result.bodies, p)) << p.transpose();
  }
  EXPECT_GT(inside, 10);
}

TEST(Cover, MutantsAreRefuted) {
  const Mesh mesh = prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1);
  const CoverCandidate result = run(mesh, 1);
  const geom::ConvexSet good = set_of(result.bodies);
  ASSERT_EQ(cover_of(mesh, good), verify::Answer::Verified);
  ASSERT_EQ(good.bodies.size(), 2U);
  for (std::size_t i = 0; i < good.bodies.size(); ++i) {
    geom::ConvexSet mutant = good;  // a body missing
    mutant.bodies.erase(mutant.bodies.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_EQ(cover_of(mesh, mutant), verify::Answer::Refuted);
    mutant = good;  // a body shrunk by a millionth
    const Vec3 center = geom::bounding_box(mutant.bodies[i].core).center();
    for (Vec3& p : mutant.bodies[i].core.vertices) p = center + (1 - 1e-6) * (p - center);
    EXPECT_EQ(cover_of(mesh, mutant), verify::Answer::Refuted);
  }
}

TEST(Cover, InteriorCornersOfCellsAreCovered) {
  // A ball is cut into many cells only when told so: few vertices per body at a small epsilon.
  const Mesh ball = kaboum::test::icosphere(2);
  const CoverCandidate result = run(ball, 3, 16);
  expect_cover(ball, result, 16);
  EXPECT_GE(result.bodies.size(), 8U);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(unit(random), unit(random), unit(random));
    EXPECT_TRUE(test::covered(result.bodies, p)) << p.transpose();
  }
}

/// A closed ring of radius 1 along z.
Mesh thin_ring(std::uint32_t segments, double inner, double height) {
  Mesh ring;
  for (std::uint32_t i = 0; i < segments; ++i) {
    const double a = 2 * M_PI * i / segments, c = std::cos(a), s = std::sin(a);
    for (const auto& [r, z] : {std::pair{inner, 0.0}, {1.0, 0.0}, {1.0, height}, {inner, height}})
      ring.vertices.emplace_back(r * c, r * s, z);
    const std::uint32_t j = (i + 1) % segments;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t l = (k + 1) % 4;
      ring.triangles.push_back({4 * i + k, 4 * j + l, 4 * i + l});
      ring.triangles.push_back({4 * i + k, 4 * j + k, 4 * j + l});
    }
  }
  return ring;
}

/// What find_cover reaches with at most so many bodies.
double reach_of(const geom::Prepared& input, std::size_t bodies, std::size_t max_vertices) {
  CoverOptions options;
  options.max_bodies = bodies;
  options.max_vertices = max_vertices;
  const CoverCandidate result = find_cover(input.solid, options);
  EXPECT_LE(result.bodies.size(), bodies);
  EXPECT_LE(result.statistics.largest, max_vertices);
  return result.excess_upper;
}

TEST(Cover, ThinRingsDistanceFallsWithTheSquareOfTheNumberOfBodies) {
  // [gaschler2016] Fig. 4.8: n equal arcs of radius r are r (1 − cos π/n) from their hulls.
  constexpr double inner = 0.99;
  const geom::Prepared input = geom::prepare(thin_ring(256, inner, 0.02));
  double xy = 0, xx = 0;  // of logarithms, about n = 16
  for (const std::size_t bodies : {8U, 16U, 32U}) {
    const double reach = reach_of(input, bodies, 64);
    EXPECT_LE(reach, 1.3 * inner * (1 - std::cos(M_PI / static_cast<double>(bodies))));
    const double x = std::log(static_cast<double>(bodies) / 16);
    xy += x * std::log(reach);
    xx += x * x;
  }
  EXPECT_NEAR(xy / xx, -2, 0.1);
}

TEST(Cover, ThinRingsOfEightVerticesPerBodyAreAsNearAsEqualSegments) {
  // The ring of the reproduction: trapezoids round equal segments are 1 / cos π/n − 1 outwards.
  const geom::Prepared input = geom::prepare(thin_ring(720, 0.998, 0.1));
  for (const std::size_t bodies : {8U, 32U})
    EXPECT_LE(reach_of(input, bodies, 8),
              1.3 * (1 / std::cos(M_PI / static_cast<double>(bodies)) - 1))
        << bodies;
}

TEST(Cover, MoreBodiesOfEightVerticesAreNoFarther) {
  const std::vector<Mesh> family{thin_ring(96, 0.995, 0.08), kaboum::test::torus(1, 0.3, 24, 12),
                                 prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1)};
  for (std::size_t i = 0; i < family.size(); ++i) {
    const geom::Prepared input = geom::prepare(family[i]);
    double last = std::numeric_limits<double>::infinity();
    for (const std::size_t bodies : {2U, 4U, 8U, 16U, 32U}) {
      const double reach = reach_of(input, bodies, 8);
      EXPECT_LE(reach, last) << i << ' ' << bodies;
      last = reach;
    }
  }
}

/// Solids of many kinds; of the meshes at hand, some links as well.
std::vector<std::pair<std::string, Mesh>> solids_to_cut() {
  std::vector<std::pair<std::string, Mesh>> out{
      {"torus", kaboum::test::torus(1, 0.3, 24, 12)},
      {"ring", thin_ring(96, 0.995, 0.08)},
      {"angle", prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1)},
      {"star", prism(test::ring(14, {1, 0.45}), 0.4)},
      {"bracket", kaboum::examples::make_bracket(16)},
      {"knot", kaboum::test::torus_knot(2, 3, 0.2, 40, 6)}};
  for (const unsigned seed : {1U, 2U, 3U}) {  // unions and differences of boxes
    std::mt19937 random(seed);
    std::array<int, 64> filled{};
    for (int& f : filled) f = random() % 3 == 0 ? 0 : 1;
    out.emplace_back(
        "boxes",
        test::lattice_solid({{{0, 1, 2.5, 3, 4}, {0, 1, 2, 3.5, 4}, {0, 0.7, 2, 3, 4}}},
                            [&](int x, int y, int z) {
                              return filled[static_cast<std::size_t>(x + 4 * y + 16 * z)] != 0;
                            }));
  }
  if (const char* folder = std::getenv("KABOUM_MESHES"))
    for (const char* file : {"clean-joint.off", "clean-knot1.off"})
      out.emplace_back(file, io::read_mesh(std::filesystem::path(folder) / file).mesh);
  return out;
}

TEST(Cover, NoNumberOfBodiesIsFartherThanASmallerPowerOfTwo) {
  for (const auto& [name, mesh] : solids_to_cut()) {
    const geom::Prepared input = geom::prepare(mesh);
    const std::size_t triangles = input.solid.mesh().triangles.size();
    const std::size_t most = triangles < 300 ? 9 : triangles < 1000 ? 4 : 2;
    CoverOptions options;
    options.effort = Effort::Fast;
    std::vector<std::pair<std::size_t, double>> rungs;
    for (std::size_t bodies = 1; bodies <= most; ++bodies) {
      options.max_bodies = bodies;
      const double reach = find_cover(input.solid, options).excess_upper;
      for (const auto& [fewer, farthest] : rungs)
        EXPECT_LE(reach, farthest) << name << ' ' << bodies << ' ' << fewer;
      if (std::has_single_bit(bodies)) rungs.emplace_back(bodies, reach);
    }
  }
  // Two bodies of a torus are farther than its hull, if they are looked for alone.
  const geom::Prepared torus = geom::prepare(kaboum::test::torus(1, 0.3, 24, 12));
  EXPECT_LE(reach_of(torus, 2, 64), reach_of(torus, 1, 64));
}

TEST(Cover, ASearchThatTakesOverWhatAnotherFoundGivesWhatItGivesAlone) {
  for (const auto& [name, mesh] : solids_to_cut()) {
    const geom::Prepared input = geom::prepare(mesh);
    const geom::SolidMesh closed = geom::close_holes(input.solid);
    const std::size_t triangles = closed.mesh().triangles.size();
    for (const Effort effort : {Effort::Fast, Effort::Normal}) {
      if (triangles > (effort == Effort::Fast ? 1000 : 200)) continue;
      CoverOptions options;
      options.effort = effort;
      options.max_bodies = 7;
      constexpr double work = 1e12;
      Decomposer first(closed.mesh(), options, work);
      first.run();
      // Fewer bodies take over all cuts of theirs, more go on after the last one.
      for (const std::size_t bodies : {2U, 5U, 9U}) {
        CoverOptions other = options;
        other.max_bodies = bodies;
        Decomposer with(first, other, work), alone(closed.mesh(), other, work);
        const CoverCandidate a = with.run(), b = alone.run();
        SCOPED_TRACE(name + ' ' + std::to_string(bodies));
        EXPECT_EQ(with.work_done(), alone.work_done());
        EXPECT_EQ(a.excess_upper, b.excess_upper);
        ASSERT_EQ(a.bodies.size(), b.bodies.size());
        for (std::size_t i = 0; i < a.bodies.size(); ++i) {
          EXPECT_EQ(a.bodies[i].core.vertices, b.bodies[i].core.vertices);
          EXPECT_EQ(a.bodies[i].core.triangles, b.bodies[i].core.triangles);
        }
      }
    }
  }
}

TEST(Cover, NormalEffortFindsNoMoreBodiesThanFast) {
  for (const auto& [name, mesh] : solids_to_cut()) {
    const geom::Prepared input = geom::prepare(mesh);
    const geom::SolidMesh closed = geom::close_holes(input.solid);
    if (closed.mesh().triangles.size() > 600) continue;
    for (const double percent : {1., 4.}) {
      CoverOptions options = test::quick(closed.mesh(), percent);
      std::array<std::size_t, 2> bodies{};
      for (const Effort effort : {Effort::Fast, Effort::Normal}) {
        options.effort = effort;
        bodies[effort == Effort::Fast ? 0 : 1] = find_cover(input.solid, options).bodies.size();
      }
      SCOPED_TRACE(name + ' ' + std::to_string(percent));
      EXPECT_LE(bodies[1], bodies[0]);
    }
  }
}

TEST(Cover, NoSetHasAsFewBodiesAsAreProvedTooFew) {
  std::size_t most = 0;
  for (const auto& [name, mesh] : solids_to_cut()) {
    const geom::Prepared input = geom::prepare(mesh);
    const Mesh& closed = input.solid.mesh();
    if (!input.solid.closed() || closed.triangles.size() > 1000) continue;
    const SolidField solid(closed, 20000, 0, false);
    for (const std::size_t bodies : {1U, 3U, 8U}) {
      CoverOptions options;
      options.max_bodies = bodies;
      options.effort = Effort::Fast;
      const CoverCandidate result = find_cover(input.solid, options);
      // Nearer by as much as the bracket is wide would be another set.
      const std::size_t few =
          too_few_bodies(closed, solid, 1.0001 * result.excess_upper, 2 * bodies);
      EXPECT_LT(few, result.bodies.size()) << name << ' ' << bodies;
      most = std::max(most, few);
    }
  }
  EXPECT_GE(most, 5U);
  // Of a convex solid, one body is enough; of a ring, n bodies are r (1 - cos pi / (n + 1)) away.
  const Mesh ball = kaboum::test::icosphere(2);
  EXPECT_EQ(too_few_bodies(ball, SolidField(ball, 20000, 0, false), 1e-3, 20), 0U);
  const Mesh thin = thin_ring(96, 0.995, 0.08);
  const SolidField field(thin, 20000, 0, false);
  for (const double n : {4.0, 8.0, 16.0}) {
    const std::size_t few =
        too_few_bodies(thin, field, 0.995 * (1 - std::cos(M_PI / n)) - 0.005, 40);
    EXPECT_GE(static_cast<double>(few), 0.6 * n);
    EXPECT_LE(static_cast<double>(few), 1.5 * n);
  }
}

TEST(Cover, WallsThinnerThanTheGridAndFlatParts) {
  // Where the interpolated distance is wrong by more than epsilon the search must still end.
  constexpr double t = 0.004;
  const Mesh angle = prism({{0, 0}, {3, 0}, {3, t}, {t, t}, {t, 3}, {0, 3}}, 2);
  Mesh flat = prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 0);
  std::erase_if(flat.triangles, [](const geom::Triangle& v) {
    return std::any_of(v.begin(), v.end(), [](std::uint32_t i) { return i > 5; });
  });
  flat.vertices.resize(6);
  for (const Mesh& mesh : {angle, flat}) {  // the flat one's hole is filled across the notch
    const CoverCandidate result = run(mesh, 0.5);
    EXPECT_EQ(result.stop, Stop::Done);
    EXPECT_LE(result.bodies.size(), 4U);
    EXPECT_LE(result.statistics.leaves, 20U);
    expect_cover(geom::fill_holes(geom::prepare(mesh).solid.mesh()).mesh, result, 64);
  }
}

TEST(Cover, PreStepKeepsCoverAndEpsilon) {
  // A ball with a cavity, which simplification may narrow; an open one; a fold that is inside out.
  Mesh hollow = kaboum::test::merged(
      {kaboum::test::icosphere(3),
       kaboum::test::flipped(kaboum::test::translated(kaboum::test::icosphere(1), Vec3(3, 0, 0)))});
  for (std::size_t v = 0; v < hollow.vertices.size(); ++v)
    if (hollow.vertices[v].x() > 1.5)
      hollow.vertices[v] = 0.5 * (hollow.vertices[v] - Vec3(3, 0, 0));
  Mesh open = kaboum::test::torus(1, 0.3, 40, 24);
  open.triangles.resize(open.triangles.size() - 40);
  for (const Mesh& mesh : {hollow, open}) {
    CoverOptions options = test::quick(mesh, 8);
    options.pre_step = PreStep::On;
    const geom::Prepared input = geom::prepare(mesh);
    const Mesh closed = geom::fill_holes(input.solid.mesh()).mesh;
    const CoverCandidate result = find_cover(input.solid, options);
    EXPECT_EQ(result.stop, Stop::Done);
    EXPECT_GT(result.statistics.pre_step_triangles, 0U);
    EXPECT_LT(2 * result.statistics.pre_step_triangles, closed.triangles.size());
    EXPECT_LE(result.excess_upper, *options.epsilon);
    test::expect_cover(closed, result, 64);
    // The distance is the one to the input: no point of the bodies is farther.
    const SolidField solid(closed, 2000, 0);
    double farthest = 0;
    for (const geom::ConvexBody& body : result.bodies)
      for (const Vec3& p : body.core.vertices)
        if (!solid.contains(p)) farthest = std::max(farthest, solid.surface().nearest(p).lower);
    EXPECT_LE(farthest, result.excess_upper);
    EXPECT_GT(farthest, 0);
    options.pre_step = PreStep::Off;
    EXPECT_EQ(find_cover(input.solid, options).statistics.pre_step_triangles, 0U);
  }
}

TEST(Cover, SameBytesForAnyNumberOfThreads) {
  const Mesh mesh = kaboum::test::torus(1, 0.3, 40, 16);
  std::vector<std::vector<char>> bytes;
  for (const std::size_t threads : {1U, 2U, 5U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    bytes.push_back(io::serialise_convex_set(set_of(run(mesh, 2).bodies), io::SetFormat::Glb));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(bytes[0], bytes[2]);
}

TEST(Cover, BodiesForADistanceAndDistanceForBodies) {
  const Mesh mesh = kaboum::test::torus(1, 0.3, 40, 16);
  const double diagonal = geom::bounding_box(mesh).diagonal();
  std::size_t last = 1000;
  for (const double percent : {4.0, 12.0}) {
    const CoverCandidate result = run(mesh, percent);
    EXPECT_EQ(result.stop, Stop::Done);
    EXPECT_LE(result.excess_upper, 0.01 * percent * diagonal);
    EXPECT_LE(result.bodies.size(), last);
    last = result.bodies.size();
  }
  CoverOptions options;
  options.effort = Effort::Fast;
  options.max_bodies = 6;
  EXPECT_LE(find_cover(geom::prepare(mesh).solid, options).bodies.size(), 6U);
}

TEST(Cover, LessSimplifiedBodiesAreNearerOnTheWhole) {
  const Mesh torus = geom::prepare(kaboum::test::torus(1, 0.3, 60, 24)).solid.mesh();
  double last_volume = 1e9;
  std::size_t last_vertices = 0;
  for (const double share : {0.5, 0.25, 0.05}) {
    CoverOptions options = test::quick(torus, 3, 64);
    options.simplify = share;
    const CoverCandidate result = find_cover(geom::prepare(torus).solid, options);
    expect_cover(torus, result, 64);
    double volume = 0;
    for (const geom::ConvexBody& body : result.bodies) volume += geom::signed_volume(body.core);
    EXPECT_LT(volume, last_volume);
    EXPECT_GT(result.statistics.vertices, last_vertices);
    last_volume = volume;
    last_vertices = result.statistics.vertices;
  }
}

TEST(Cover, FewVerticesPerBodyReachEpsilonWithMoreBodies) {
  const Mesh torus = geom::prepare(kaboum::test::torus(1, 0.3, 40, 16)).solid.mesh();
  std::size_t last = 1000;
  for (const std::size_t most : {8U, 12U, 24U}) {
    const CoverCandidate result = run(torus, 2, most);
    expect_cover(torus, result, most);
    EXPECT_EQ(result.stop, Stop::Done);
    EXPECT_LT(result.bodies.size(), last);
    last = result.bodies.size();
  }
}

TEST(Cover, LimitOfAllVerticesTogether) {
  const Mesh mesh = kaboum::test::torus(1, 0.3, 12, 6);
  CoverOptions options;
  options.max_bodies = 6;
  options.max_total_vertices = 60;
  const CoverCandidate result = find_cover(geom::prepare(mesh).solid, options);
  EXPECT_EQ(result.stop, Stop::Done);
  EXPECT_LE(result.bodies.size(), 6U);
  EXPECT_LE(result.statistics.vertices, 60U);
  test::expect_cover(mesh, result, 64);
  // The same share for each body reaches farther.
  options.max_total_vertices.reset();
  options.max_vertices = 10;
  EXPECT_LT(result.excess_upper, find_cover(geom::prepare(mesh).solid, options).excess_upper);
  // Within an epsilon that they do not allow, the best is given.
  const Mesh beam = prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1);
  options = test::quick(beam, 1);
  options.max_total_vertices = 12;
  const CoverCandidate few = find_cover(geom::prepare(beam).solid, options);
  EXPECT_EQ(few.stop, Stop::TooManyBodies);
  EXPECT_LE(few.statistics.vertices, 12U);
  options.max_total_vertices = 16;
  EXPECT_EQ(find_cover(geom::prepare(beam).solid, options).stop, Stop::Done);
}

// What epsilon's search makes of the pieces must not make the limit's worse.
TEST(Cover, EpsilonThatTheLimitReachesIsReached) {
  const geom::Prepared solid = geom::prepare(kaboum::examples::make_bracket(16));
  for (const Effort effort : {Effort::Fast, Effort::Normal}) {
    for (const std::size_t most : {2, 3, 6}) {
      CoverOptions options;
      options.effort = effort;
      options.max_bodies = most;
      const CoverCandidate alone = find_cover(solid.solid, options);
      options.epsilon = 1.001 * alone.excess_upper;
      const CoverCandidate both = find_cover(solid.solid, options);
      EXPECT_EQ(both.stop, Stop::Done) << most;
      EXPECT_LE(both.excess_upper, *options.epsilon) << most;
      options.epsilon = 0.3 * alone.excess_upper;
      EXPECT_LE(find_cover(solid.solid, options).excess_upper, alone.excess_upper) << most;
    }
  }
}

TEST(Cover, LimitsWithinEpsilonCountAsReached) {
  // 40 × 24 × 2 triangles: the pre-step takes some of epsilon, and what limits then do not allow
  // they may allow without it.
  const Mesh mesh = kaboum::test::torus(1, 0.3, 40, 24);
  const geom::Prepared input = geom::prepare(mesh);
  CoverOptions options = test::quick(mesh, 8);
  const std::size_t free = find_cover(input.solid, options).bodies.size();
  for (const PreStep pre_step : {PreStep::Off, PreStep::On}) {
    options.pre_step = pre_step;
    options.max_bodies = free;
    const CoverCandidate held = find_cover(input.solid, options);
    EXPECT_EQ(held.stop, Stop::Done);
    EXPECT_LE(held.bodies.size(), free);
    EXPECT_LE(held.excess_upper, *options.epsilon);
    options.max_bodies = 2;
    const CoverCandidate few = find_cover(input.solid, options);
    EXPECT_EQ(few.stop, Stop::TooManyBodies);
    EXPECT_LE(few.bodies.size(), 2U);
    EXPECT_GT(few.excess_upper, *options.epsilon);
  }
}

TEST(Cover, ClosedMeshesInOnePlaneAreRefused) {
  Mesh flat = kaboum::test::torus(1, 0.3, 12, 8);
  for (Vec3& p : flat.vertices) p.z() = 0;
  EXPECT_THROW(find_cover(geom::prepare(flat).solid, test::quick(flat, 2)), Error);
}

TEST(Cover, ContradictoryOptions) {
  const geom::Prepared input = geom::prepare(kaboum::test::box(Vec3(1, 1, 1), 1));
  EXPECT_THROW(find_cover(input.solid, {}), Error);
  CoverOptions options;
  options.epsilon = -1;
  EXPECT_THROW(find_cover(input.solid, options), Error);
  options.epsilon = 1;
  options.max_vertices = 7;
  EXPECT_THROW(find_cover(input.solid, options), Error);
  options.max_vertices = 8;
  options.max_total_vertices = 7;
  EXPECT_THROW(find_cover(input.solid, options), Error);
}

}  // namespace
}  // namespace kaboum::bcd
