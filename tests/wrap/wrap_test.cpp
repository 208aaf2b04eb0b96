// Every triangle of any soup is inside its wrap: judged by libverify, and by exact winding numbers
// of an oracle that shares no code with either. Gaps narrower than asked for are closed.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/base/random.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/self_intersection.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/wrap/wrap.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "independent_check.h"
#include "support/families.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::wrap {
namespace {

using geom::Mesh;
using geom::Vec3;

Mesh random_soup(std::uint64_t seed, int count, double size) {
  Random random(seed);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto point = [&](double s) {
      const double x = random.between(-s, s), y = random.between(-s, s), z = random.between(-s, s);
      return Vec3(x, y, z);
    };
    const Vec3 at = point(1);
    for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(at + point(size));
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.triangles.push_back({n - 3, n - 2, n - 1});
  }
  return mesh;
}

constexpr int kRings = 48;

/// A sphere of which a cap of so many rings is missing.
Mesh sphere_with_hole(int rings) {
  const double height = std::cos((rings + 0.1) * std::numbers::pi / kRings);
  return test::without(test::uv_sphere(48, kRings), [&](const Vec3& p) { return p.z() > height; });
}

Wrap wrapped(const Mesh& mesh, double offset, double seal) {
  const double diagonal = geom::bounding_box(mesh).diagonal();
  WrapOptions options;
  options.offset = offset * diagonal;
  options.seal = seal * diagonal;
  return wrap(mesh, options);
}

void expect_clean(const Mesh& wrap, const std::string& name) {
  EXPECT_TRUE(geom::self_intersections(wrap).none()) << name;
  EXPECT_FALSE(meets_itself_by_cgal(wrap)) << name;
  const geom::TopologyReport topology = geom::analyse(wrap);
  EXPECT_TRUE(topology.closed() && topology.manifold()) << name;
  EXPECT_EQ(topology.vertices, geom::analyse(geom::weld(wrap)).vertices) << name;
}

void expect_inside(const Mesh& mesh, const Mesh& wrap, const std::string& name) {
  ASSERT_TRUE(test::closed_chain(wrap)) << name;
  expect_clean(wrap, name);
  EXPECT_EQ(test::share_beyond_float(wrap), 0) << name;
  verify::InclusionOptions options;
  options.surface_only = true;
  EXPECT_EQ(verify::verify_inclusion(mesh, wrap, options).surface.answer, verify::Answer::Verified)
      << name;
  Random random(5);
  for (int i = 0; i < 12; ++i) {
    const geom::Triangle& t = mesh.triangles[random.index(mesh.triangles.size())];
    const std::optional<int> w = test::winding_number_slow(wrap, mesh.vertices[t[i % 3]]);
    ASSERT_TRUE(w) << name << ": a corner lies on the wrap";
    EXPECT_GE(*w, 1) << name;
  }
}

TEST(Wrap, HoldsAllFamilies) {
  for (const auto& families : {test::closed_families(), test::open_families()}) {
    for (const test::Family& family : families) {
      if (geom::bounding_box(family.mesh).diagonal() == 0) continue;
      const double far = geom::bounding_box(family.mesh).max.cwiseAbs().maxCoeff() /
                         geom::bounding_box(family.mesh).diagonal();
      if (far > 1e3) continue;  // float32 is too coarse there
      expect_inside(family.mesh, wrapped(family.mesh, 0.01, 0.08).mesh, family.name);
    }
  }
}

TEST(Wrap, HoldsSoups) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Mesh soup = random_soup(seed, 60, seed % 2 == 0 ? 0.5 : 0.03);
    expect_inside(soup, wrapped(soup, 0.003, 0.05).mesh, "soup " + std::to_string(seed));
  }
  expect_inside(test::moebius_strip(40, 4), wrapped(test::moebius_strip(40, 4), 0.01, 0.05).mesh,
                "moebius");
  Mesh sheet = test::grid(6, [](double x, double y) { return 0.3 * x * y; });
  expect_inside(sheet, wrapped(sheet, 0.01, 0.05).mesh, "sheet");
  expect_inside(test::merged({sheet, test::flipped(sheet)}),
                wrapped(test::merged({sheet, test::flipped(sheet)}), 0.01, 0.05).mesh,
                "doubly faced");
  Mesh one;
  one.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {{0, 1, 2}};
  expect_inside(one, wrapped(one, 0.01, 0.1).mesh, "one triangle");
}

/// A ring of rectangular section: a plate with one round hole.
Mesh ring(double inner, double outer, double height, int segments) {
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    const double a = 2 * std::numbers::pi * i / segments, x = std::cos(a), y = std::sin(a);
    mesh.vertices.insert(mesh.vertices.end(),
                         {Vec3(outer * x, outer * y, 0), Vec3(outer * x, outer * y, height),
                          Vec3(inner * x, inner * y, height), Vec3(inner * x, inner * y, 0)});
  }
  const auto vertex = [&](int i, int k) {
    return static_cast<std::uint32_t>(4 * (i % segments) + k % 4);
  };
  for (int i = 0; i < segments; ++i) {
    for (int k = 0; k < 4; ++k) {
      mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1)});
      mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1)});
    }
  }
  return mesh;
}

double farthest(const Mesh& mesh, const Mesh& around) {
  const geom::DistanceQuery query(mesh);
  return geom::directed_distance(around, query, {.relative_gap = 0.01}).max_upper /
         geom::bounding_box(mesh).diagonal();
}

/// A ball that fits through a hole opens it, with a clearance as well: long tetrahedra there have
/// corners as their nearest points to the hole's edges.
TEST(Wrap, OpensHolesWithAClearance) {
  for (const double inner : {0.5, 1.0}) {
    const Mesh plate = ring(inner, 1.5, 0.4, 64);
    EXPECT_GT(geom::signed_volume(plate), 0);
    const double diagonal = geom::bounding_box(plate).diagonal();
    WrapOptions options;
    options.offset = 0.005 * diagonal;
    options.seal = 0.03 * diagonal;
    options.clearance = 0.0005 * diagonal;
    const Mesh around = wrap(plate, options).mesh;
    expect_inside(plate, around, "ring");
    EXPECT_LT(farthest(plate, around), 0.005 + 0.015);
    EXPECT_LT(geom::signed_volume(around), 1.2 * geom::signed_volume(plate));
  }
}

/// Where outside and a hollow meet in a vertex, only what is near it is filled.
TEST(Wrap, StaysNearWhereHolesAreAsWideAsTheBall) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Random random(seed);
    const Mesh shell =
        test::without(test::icosphere(4), [&](const Vec3&) { return random.between(0, 1) < 0.12; });
    const Mesh around = wrapped(shell, 0.003, 0.03).mesh;
    expect_inside(shell, around, "shell");
    EXPECT_LT(farthest(shell, around), 1.1 * (0.003 + 0.015));
  }
}

/// Plates with square holes, of which the surfaces on both sides of a wall are near each other.
TEST(Wrap, OfAPlateWithHolesIsTight) {
  std::vector<Mesh> bars;
  for (int i = 0; i <= 6; ++i) {
    bars.push_back(test::translated(test::box({6.4, 0.4, 0.2}, 1), {0, 1.0 * i, 0}));
    bars.push_back(test::translated(test::box({0.4, 6.4, 0.2}, 1), {1.0 * i, 0, 0}));
  }
  const Mesh plate = test::merged(bars);
  const double diagonal = geom::bounding_box(plate).diagonal();
  for (const double seal : {0.02, 0.05, 0.2}) {
    const Mesh around = wrapped(plate, 0.002, seal).mesh;
    expect_inside(plate, around, "plate");
    // Holes of a side of 0.6 stay open where the ball goes through them.
    const double whole = 6.4 * 6.4, holes = 36 * 0.6 * 0.6, border = 2 * 0.002 * diagonal;
    const double height = geom::bounding_box(plate).max.z() - geom::bounding_box(plate).min.z();
    const double area =
        seal < 0.06 ? whole - holes + border * (4 * 6.4 + 36 * 4 * 0.6) : whole + border * 4 * 6.4;
    EXPECT_LT(geom::signed_volume(around), 1.1 * area * (height + border)) << seal;
    if (seal > 0.1) {
      EXPECT_GT(geom::signed_volume(around), 0.9 * whole * height);
    }
  }
}

/// A hundred triangles through each other: as large as an alpha wrap, which is 1.8 times their
/// area times the offset's two sides at most where nothing is sealed.
TEST(Wrap, OfASoupIsTight) {
  const Mesh soup = random_soup(11, 100, 0.5);
  const double offset = 0.002 * geom::bounding_box(soup).diagonal();
  const Mesh around = wrapped(soup, 0.002, 0.02).mesh;
  expect_inside(soup, around, "soup");
  EXPECT_LT(geom::signed_volume(around), 1.8 * 2 * offset * geom::area(soup));
}

TEST(Wrap, OfTouchingPartsAndCavities) {
  // Cubes that share a corner, and an edge; a box in a hollow box.
  const Mesh cube = test::box({1, 1, 1}, 2);
  for (const Vec3& at : {Vec3(1, 1, 1), Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(1.001, 1, 1)})
    expect_inside(test::merged({cube, test::translated(cube, at)}),
                  wrapped(test::merged({cube, test::translated(cube, at)}), 0.005, 0.05).mesh,
                  "cubes");
  const Mesh nested = test::merged(
      {test::box({3, 3, 3}, 1), test::flipped(test::box({2, 2, 2}, 1)), test::box({1, 1, 1}, 1)});
  const Mesh around = wrapped(nested, 0.002, 0.1).mesh;
  expect_inside(nested, around, "nested");
  EXPECT_NEAR(geom::signed_volume(around), 27, 0.5);
}

TEST(Wrap, OfAnySizeAndPlace) {
  const Mesh soup = random_soup(3, 15, 0.5);
  for (const double scale : {0x1p-100, 0x1p-30, 0x1p30, 0x1p100}) {
    Mesh scaled = soup;
    for (Vec3& p : scaled.vertices) p *= scale;
    expect_inside(scaled, wrapped(scaled, 0.005, 0.05).mesh, "scaled");
  }
  const Mesh far = test::translated(soup, {1e4, -2e4, 3e4});
  expect_inside(far, wrapped(far, 0.005, 0.05).mesh, "far");
}

/// A triangle so thin, and a cluster so small, that it could slip through a tetrahedron.
TEST(Wrap, HoldsWhatIsSmall) {
  Mesh tiny;
  tiny.vertices = {{0, 0, 0},      {1e-4, 0, 0},    {0, 1e-5, 0},    {1, 1, 1},      {1, 1, 1},
                   {1, 1, 1.0001}, {0.3, 0.9, 0.1}, {0.3, 0.9, 0.1}, {0.3, 0.9, 0.1}};
  tiny.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const Wrap result = wrapped(tiny, 0.005, 0.1);
  ASSERT_TRUE(test::closed_chain(result.mesh));
  for (const Vec3& p : tiny.vertices) {
    const std::optional<int> w = test::winding_number_slow(result.mesh, p);
    ASSERT_TRUE(w);
    EXPECT_GE(*w, 1);
  }
}

TEST(Wrap, ClosesNarrowGapsAndLeavesWideOnesOpen) {
  const double diagonal = 2 * std::numbers::sqrt3;
  for (const int rings : {3, 5}) {
    const double width = 2 * std::sin(rings * std::numbers::pi / kRings);
    const Mesh shell = sphere_with_hole(rings);
    const Mesh closed = wrapped(shell, 0.005, 1.2 * width / diagonal).mesh;
    const Mesh open = wrapped(shell, 0.005, width / 3.5 / diagonal).mesh;
    EXPECT_EQ(test::winding_number_slow(closed, Vec3::Zero()), 1) << width;
    EXPECT_EQ(test::winding_number_slow(open, Vec3::Zero()), 0) << width;
    expect_inside(shell, closed, "closed");
    expect_inside(shell, open, "open");
  }
}

TEST(Wrap, IsNearWhereNothingIsSealed) {
  const Mesh sphere = test::icosphere(4);
  const double diagonal = geom::bounding_box(sphere).diagonal();
  const Wrap result = wrapped(sphere, 0.01, 0.1);
  const geom::DistanceQuery query(sphere);
  EXPECT_LT(geom::directed_distance(result.mesh, query).max_upper, 0.015 * diagonal);
  EXPECT_LT(result.mesh.triangles.size(), result.first_triangles);
}

/// All within the clearance of a triangle is inside: the nearest points of the wrap are no nearer.
TEST(Wrap, KeepsAClearance) {
  for (const Mesh& mesh : {test::icosphere(2), random_soup(4, 20, 0.4)}) {
    const double diagonal = geom::bounding_box(mesh).diagonal();
    WrapOptions options;
    options.offset = 0.02 * diagonal;
    options.seal = 0.1 * diagonal;
    options.clearance = 0.006 * diagonal;
    const Mesh around = wrap(mesh, options).mesh;
    expect_inside(mesh, around, "with clearance");
    const geom::DistanceQuery query(mesh), back(around);
    for (const Vec3& v : around.vertices) EXPECT_GT(query.nearest(v).upper, options.clearance);
    Random random(1);
    for (int i = 0; i < 400; ++i) {
      const geom::Triangle& t = mesh.triangles[random.index(mesh.triangles.size())];
      const double a = random.between(0, 0.5), b = random.between(0, 0.5);
      const Vec3 p =
          (1 - a - b) * mesh.vertices[t[0]] + a * mesh.vertices[t[1]] + b * mesh.vertices[t[2]];
      EXPECT_GT(back.nearest(p).upper, options.clearance);
    }
    options.clearance = 0.01 * diagonal;
    EXPECT_THROW(wrap(mesh, options), Error);
  }
}

/// With a clearance of nearly a third of the offset, the surface goes to the middle of what is
/// left: it is not held up at tips and edges.
TEST(Wrap, GetsNearTipsWithAClearance) {
  for (const int segments : {12, 72, 200}) {
    for (const double height : {1.0, 2.0, 4.0}) {
      const Mesh mesh = test::cone(segments, height);
      const double diagonal = geom::bounding_box(mesh).diagonal();
      WrapOptions options;
      options.offset = 0.01 * diagonal;
      options.seal = 4 * options.offset;
      options.clearance = 0.32 * options.offset;
      const Mesh around = wrap(mesh, options).mesh;
      const geom::DistanceQuery query(mesh);
      EXPECT_LT(geom::directed_distance(around, query, {.relative_gap = 0.01}).max_upper,
                2 * options.offset)
          << segments << ' ' << height;
    }
  }
}

TEST(Wrap, IsTheSameForAnyNumberOfThreads) {
  const Mesh soup = random_soup(2, 200, 0.2);
  Mesh first;
  for (const std::size_t threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Mesh mesh = wrapped(soup, 0.004, 0.04).mesh;
    if (first.empty()) first = mesh;
    EXPECT_EQ(mesh.vertices, first.vertices);
    EXPECT_EQ(mesh.triangles, first.triangles);
  }
}

/// What the judges are for: a wrap of which one vertex is pushed through the input is refuted.
TEST(Wrap, ADamagedWrapIsRefuted) {
  const Mesh sphere = test::icosphere(3);
  Mesh mesh = wrapped(sphere, 0.01, 0.1).mesh;
  mesh.vertices[mesh.triangles[0][0]] *= 0.8;
  verify::InclusionOptions options;
  options.surface_only = true;
  EXPECT_EQ(verify::verify_inclusion(sphere, mesh, options).surface.answer,
            verify::Answer::Refuted);
}

TEST(Wrap, RefusesWhatCannotBe) {
  const auto code = [](const Mesh& mesh, const WrapOptions& options) {
    try {
      wrap(mesh, options);
    } catch (const Error& e) {
      return e.code();
    }
    return ErrorCode::Internal;
  };
  WrapOptions options;
  options.offset = 0.01;
  options.seal = 0.1;
  EXPECT_EQ(code({}, options), ErrorCode::InvalidInput);
  Mesh cube = test::box({1, 1, 1}, 1);
  EXPECT_EQ(code(test::translated(cube, {1e9, 0, 0}), options), ErrorCode::InvalidInput);
  options.max_points = 100;
  EXPECT_EQ(code(cube, options), ErrorCode::LimitReached);
  options.seal = 0;
  EXPECT_EQ(code(cube, options), ErrorCode::InvalidArgument);
  options.seal = std::nan("");
  EXPECT_EQ(code(cube, options), ErrorCode::InvalidArgument);
  cube.vertices[0].x() = std::nan("");
  options.seal = 0.1;
  EXPECT_EQ(code(cube, options), ErrorCode::InvalidInput);
}

/// The farthest distance of a wrap's points from the input, rounded up.
double far_from(const Mesh& mesh, const Mesh& wrap) {
  return geom::directed_distance(wrap, geom::DistanceQuery(mesh), {.relative_gap = 0.01}).max_upper;
}

/// Faces need no more points the finer a wrap is, edges hardly any: facets rest.
TEST(Wrap, OfFacesNeedsFewPoints) {
  const Mesh plate{{{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0.1}}, {{0, 1, 2}}};
  for (const Mesh& mesh : {plate, test::box({1, 1, 1}, 1), test::box({1, 1, 0.01}, 7)}) {
    for (const double offset : {1e-3, 1e-4}) {
      WrapOptions options;
      options.offset = offset;
      options.seal = 10 * offset;
      const Wrap made = wrap(mesh, options);
      EXPECT_LT(made.points, 3'000U) << offset;
      expect_inside(mesh, made.mesh, std::to_string(offset));
      EXPECT_LT(far_from(mesh, made.mesh), 4 * offset) << offset;
    }
  }
}

/// A facet over the mouth of a slot does not rest, however narrow the slot is beside the facet.
TEST(Wrap, GoesIntoSlotsInLargeFaces) {
  // Two blocks with a gap between them, wider than what is sealed.
  Mesh blocks = test::box({1, 1, 0.5}, 1);
  const Mesh other = test::translated(blocks, {1.012, 0, 0});
  const auto count = static_cast<std::uint32_t>(blocks.vertices.size());
  blocks.vertices.insert(blocks.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles)
    blocks.triangles.push_back({a + count, b + count, c + count});
  WrapOptions options;
  options.offset = 1e-3;
  options.seal = 0.01;
  const Wrap made = wrap(blocks, options);
  expect_inside(blocks, made.mesh, "blocks");
  // In the middle of the gap one would be 6 mm away.
  EXPECT_LT(far_from(blocks, made.mesh), 4e-3);
  options.seal = 0.014;
  EXPECT_GT(far_from(blocks, wrap(blocks, options).mesh), 5e-3);
}

TEST(Wrap, WhatIsMuchTooFineIsRefusedAtOnce) {
  // What the refusal counts on where no facet can rest: points of the tetrahedra by area over the
  // square of the radius.
  const Mesh plate{{{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0.1}}, {{0, 1, 2}}};
  for (const Mesh& mesh : {plate, test::box({1, 1, 1}, 1), test::box({1, 1, 0.01}, 1)}) {
    for (const double seal : {0.2, 0.1, 0.05}) {
      WrapOptions options;
      options.seal = seal;
      options.offset = seal / 2;
      double area = 0;
      for (const auto& [u, v, w] : mesh.triangles)
        area = std::max(area, (mesh.vertices[v] - mesh.vertices[u])
                                      .cross(mesh.vertices[w] - mesh.vertices[u])
                                      .norm() /
                                  2);
      EXPECT_GE(static_cast<double>(wrap(mesh, options).points), 0.5 * area / (seal * seal / 4));
    }
  }
  WrapOptions options;
  options.float32 = false;
  options.seal = 1e-7;
  options.offset = 5e-8;
  try {
    wrap(plate, options);  // for minutes, without the refusal
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::LimitReached);
  }
}

}  // namespace
}  // namespace kaboum::wrap
