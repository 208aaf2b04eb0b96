// Bounding meshes of any triangles: where the certificate says that every triangle is inside, it
// is, by the arrangement of all of them; and where a mesh's own solid does not do, its wrap takes
// its place.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/convex_set.h>
#include <kaboum/certify/large_epsilon.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/verify/inclusion.h>

#include <array>
#include <random>
#include <string>

#include "support/arrangement_oracle.h"
#include "support/shapes.h"

namespace kaboum::certify {
namespace {

using bmesh::Direction;
using geom::Mesh;
using geom::Vec3;
using verify::Answer;
using Wrap = MeshPreparation::Wrap;

MeshRequest fast(std::size_t vertices, Direction direction = Direction::Outer) {
  MeshRequest request;
  request.direction = direction;
  request.vertices = {vertices};
  request.effort = bmesh::Effort::Fast;
  request.decide = request.measure = false;
  return request;
}

MeshPreparation coarse(Wrap wrap = Wrap::WhereNeeded) {
  MeshPreparation preparation;
  preparation.wrap = wrap;
  preparation.wrapping.seal = kaboum::Length{20, true};
  preparation.wrapping.offset = kaboum::Length{5, true};
  return preparation;
}

/// A prism over a bow tie: the smaller one of its two halves is inside out.
Mesh bow_tie() {
  Mesh mesh;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{-1, 1}, {8, -4}, {8, 4}, {-1, -1}})
      mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    mesh.triangles.push_back({i, j, 4 + j});
    mesh.triangles.push_back({i, 4 + j, 4 + i});
  }
  return mesh;
}

Mesh soup(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> at(0, 4), by(-1, 1);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 middle(at(random), at(random), at(random));
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(middle + Vec3(by(random), by(random), by(random)));
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  return mesh;
}

struct Case {
  std::string name;
  Mesh mesh;
};

/// Folded, crossing, open, two-sided, inside out, in pieces.
std::vector<Case> bad_meshes() {
  std::vector<Case> all{
      {"bow tie", bow_tie()}, {"soup of 5", soup(5, 1)}, {"soup of 12", soup(12, 2)}};
  const Mesh ball = test::icosphere(1);
  Mesh spiked = ball;  // through the other side, and out again
  spiked.vertices[0] *= -1.7;
  all.push_back({"spiked", spiked});
  all.push_back(
      {"spiked and open", test::without(spiked, [](const Vec3& p) { return p.z() > 0.7; })});
  all.push_back({"open", test::without(ball, [](const Vec3& p) { return p.z() > 0.3; })});
  all.push_back({"inside out", test::flipped(ball)});
  all.push_back({"crossing", test::merged({ball, test::translated(ball, {0.9, 0.2, 0.1})})});
  all.push_back({"crossing, one inside out",
                 test::merged({ball, test::translated(test::flipped(ball), {0.9, 0.2, 0.1})})});
  Mesh sheet;
  sheet.vertices = {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  all.push_back({"sheet", sheet});
  all.push_back({"ball and sheet", test::merged({ball, sheet})});
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};  // its sides split otherwise
  all.push_back({"ball and odd sheet", test::merged({ball, sheet})});
  all.push_back({"Moebius strip", test::moebius_strip(12, 1)});
  all.push_back({"grid", test::grid(3, [](double x, double y) { return x * y; })});
  Mesh apart = test::soup(ball);
  all.push_back({"pieces of a ball", apart});
  return all;
}

bool all_inside(const Mesh& input, const Mesh& result) {
  const test::ArrangementVerdict verdict =
      test::arrangement_verdict(test::with_area(test::welded(input)), result);
  return verdict.surface && *verdict.surface;
}

TEST(BoundMesh, EveryTriangleIsInsideWhereItIsSaidToBe) {
  std::size_t wrapped = 0, said = 0;
  for (const Case& c : bad_meshes())
    for (const Wrap wrap : {Wrap::WhereNeeded, Wrap::Never})
      for (const bool decide : {false, true}) {
        SCOPED_TRACE(c.name);
        MeshRequest request = fast(40);
        request.decide = decide;
        BoundedMesh made;
        try {
          made = bound_mesh(c.mesh, request, coarse(wrap));
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::InvalidInput) << error.what();
          EXPECT_EQ(wrap, Wrap::Never) << error.what();
          continue;
        }
        ASSERT_EQ(made.series.meshes.size(), 1U);
        const bool is_said = made.surface_answer() == Answer::Verified;
        if (wrap == Wrap::WhereNeeded) {
          EXPECT_TRUE(is_said);
        }
        wrapped += made.wrap ? 1 : 0;
        said += is_said ? 1 : 0;
        EXPECT_EQ(made.wrap.has_value(), !made.why_wrapped.empty());
        EXPECT_EQ(is_said, all_inside(c.mesh, made.series.meshes.front().artefact()));
      }
  EXPECT_GT(wrapped, 6U);
  EXPECT_GT(said, 30U);
}

TEST(BoundMesh, AWrapCountsTowardsEpsilon) {
  MeshRequest request = fast(4);
  request.vertices.clear();
  request.epsilon = kaboum::Length{10, true};
  request.measure = true;
  const BoundedMesh made = bound_mesh(bow_tie(), request);
  ASSERT_TRUE(made.wrap);
  const double epsilon = 0.1 * made.wrap->diagonal;
  const MeshCertificate& c = made.series.meshes.front().certificate();
  EXPECT_LE(*c.epsilon + made.wrap->farthest_upper, epsilon * (1 + 1e-12));
  EXPECT_TRUE(c.subject.wrapped);
  EXPECT_TRUE(all_inside(bow_tie(), made.series.meshes.front().artefact()));
}

TEST(BoundMesh, WhatIsAskedForIsKept) {
  // Who says what the solid is, or wants the steps, gets that, and what does not hold of it.
  MeshPreparation kept;
  kept.options.keep_orientation = true;
  EXPECT_EQ(bound_mesh(bow_tie(), fast(8), kept).surface_answer(), Answer::Refuted);
  kept = {};
  kept.options.holes = geom::Holes::Keep;
  const Mesh open = test::without(test::icosphere(1), [](const Vec3& p) { return p.z() > 0.3; });
  EXPECT_EQ(bound_mesh(open, fast(8), kept).surface_answer(), Answer::Undefined);
  MeshRequest request = fast(8);
  request.record_steps = true;
  const BoundedMesh recorded = bound_mesh(bow_tie(), request);
  EXPECT_FALSE(recorded.wrap);
  EXPECT_EQ(recorded.surface_answer(), Answer::Refuted);
  EXPECT_FALSE(recorded.why_not_wrapped.empty());
  // Within a wrap is not within the mesh.
  const BoundedMesh inner = bound_mesh(bow_tie(), fast(8, Direction::Inner));
  EXPECT_FALSE(inner.wrap);
  EXPECT_EQ(inner.surface_answer() == Answer::Verified,
            all_inside(inner.series.meshes.front().artefact(), bow_tie()));
  EXPECT_THROW(bound_mesh(bow_tie(), fast(8, Direction::Inner), coarse(Wrap::Always)), Error);
}

TEST(BoundMesh, SegmentsThatStickOutAreFound) {
  Mesh mesh = test::icosphere(1);
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(3, 0, 0);
  mesh.triangles.push_back({0, n, n});
  EXPECT_EQ(bound_mesh(mesh, fast(40), coarse(Wrap::Never)).surface_answer(), Answer::Refuted);
  mesh.vertices[n] = {0.1, 0, 0};
  const BoundedMesh within = bound_mesh(mesh, fast(40), coarse());
  EXPECT_EQ(within.surface_answer(), Answer::Verified);
  EXPECT_FALSE(within.wrap);
}

TEST(BoundMesh, WallsThatReachOutAreFound) {
  // Two boxes on each other; across their common face a plate of two coincident sheets, which
  // cancel, its middle and its corners inside: a notch of the boxes lets it out in between.
  Mesh notched;  // an L over z from 0 to 1, and a U beside the notch
  const std::vector<std::pair<double, double>> outline{{0, 0}, {6, 0},   {6, 4},   {4, 4},
                                                       {4, 3}, {3.9, 3}, {3.9, 4}, {0, 4}};
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : outline) notched.vertices.emplace_back(x, y, z);
  const std::vector<geom::Triangle> cap{{0, 1, 4}, {1, 2, 3}, {1, 3, 4},
                                        {0, 4, 5}, {0, 5, 7}, {5, 6, 7}};
  for (const auto& [a, b, c] : cap) {
    notched.triangles.push_back({a, c, b});
    notched.triangles.push_back({n + a, n + b, n + c});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    notched.triangles.push_back({i, j, n + j});
    notched.triangles.push_back({i, n + j, n + i});
  }
  Mesh plate;  // its third corner's side crosses the notch above its floor
  plate.vertices = {{1, 3.5, 0.5}, {5, 3.5, 0.5}, {3, 0.5, 0.5}};
  plate.triangles = {{0, 1, 2}, {0, 2, 1}};
  const Mesh mesh = test::merged({notched, plate});
  const geom::Prepared prepared = prepare_mesh(mesh);
  ASSERT_EQ(prepared.report.left_out.size(), 2U);
  const auto bare = certify_mesh(prepared, fast(notched.vertices.size()));
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->certificate().surface_answer(), Answer::Refuted);
  EXPECT_EQ(bare->certificate().surface->sticks_out.triangle / 2,
            notched.triangles.size() / 2);  // one of the plate's
  MeshRequest decided = fast(notched.vertices.size());
  decided.decide = true;
  EXPECT_EQ(certify_mesh(prepared, decided)->certificate().surface_answer(), Answer::Refuted);
  const BoundedMesh made = bound_mesh(mesh, fast(60), coarse());
  EXPECT_TRUE(made.wrap);
  EXPECT_TRUE(all_inside(mesh, made.series.meshes.front().artefact()));
}

TEST(BoundMesh, QuadsAreSplitSoThatBothWaysAreBounded) {
  // A box whose top is bent in the middle, up or down; of quads that are split either way.
  for (const double bend : {0.2, -0.2})
    for (const Direction direction : {Direction::Outer, Direction::Inner}) {
      std::vector<Mesh> ways;
      for (const bool other : {false, true}) {
        Mesh mesh = test::welded(test::box({1, 1, 1}, 1));
        for (Vec3& v : mesh.vertices)
          if (v.x() == 1 && v.y() == 1 && v.z() == 1) v.z() += bend;
        std::array<std::uint32_t, 4> top{};
        for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
          const Vec3& p = mesh.vertices[v];
          if (p.z() < 0.5) continue;
          top[p.x() < 0.5 ? (p.y() < 0.5 ? 0 : 3) : (p.y() < 0.5 ? 1 : 2)] = v;
        }
        std::erase_if(mesh.triangles, [&](const geom::Triangle& t) {
          return std::all_of(t.begin(), t.end(),
                             [&](std::uint32_t v) { return mesh.vertices[v].z() > 0.5; });
        });
        const std::size_t o = other ? 1 : 0;
        mesh.triangles.push_back({top[o], top[o + 1], top[o + 2]});
        mesh.triangles.push_back({top[o], top[o + 2], top[(o + 3) % 4]});
        ways.push_back(mesh);
      }
      for (const Mesh& given : ways) {
        MeshPreparation preparation;
        preparation.options.quads = {static_cast<std::uint32_t>(given.triangles.size() - 2)};
        preparation.options.diagonal = direction == Direction::Outer
                                           ? geom::PrepareOptions::Diagonal::Outward
                                           : geom::PrepareOptions::Diagonal::Inward;
        for (const bool turned : {false, true}) {  // prepared, it is turned back
          const BoundedMesh made =
              bound_mesh(turned ? test::flipped(given) : given, fast(8, direction), preparation);
          const Mesh& result = made.series.meshes.front().artefact();
          for (const Mesh& way : ways) {
            const auto verdict = direction == Direction::Outer
                                     ? test::arrangement_verdict(way, result)
                                     : test::arrangement_verdict(result, way);
            EXPECT_TRUE(verdict.solid && *verdict.solid) << bend << turned;
            EXPECT_TRUE(verdict.surface && *verdict.surface) << bend << turned;
          }
        }
      }
    }
}

// A soup's triangles, closed by their own copies, have no room to move: doubles that are no float32
// numbers stay where they are. STL holds no others, and the wrap takes the soup's place.
TEST(BoundMesh, WhatHasNoFloat32PlaceIsWrapped) {
  MeshRequest request = fast(20);
  request.format = io::Format::Stl;
  const Mesh input = soup(5, 1);
  const BoundedMesh made = bound_mesh(input, request, coarse());
  ASSERT_EQ(made.series.meshes.size(), 1U) << made.why_not_wrapped;
  ASSERT_TRUE(made.wrap);
  EXPECT_NE(made.why_wrapped.find("without a certified float32 position"), std::string::npos)
      << made.why_wrapped;
  EXPECT_TRUE(all_inside(input, made.series.meshes[0].artefact()));
  const BoundedMesh stuck = bound_mesh(input, request, coarse(Wrap::Never));
  ASSERT_TRUE(stuck.series.shortage && stuck.series.meshes.empty());
  EXPECT_EQ(remedy_of(*stuck.series.shortage).find("origin"), std::string::npos);
}

// Where float32 numbers are too far apart for a wrap, it takes doubles if the result may.
TEST(BoundMesh, FarAwayWrapsTakeDoubles) {
  const Mesh far = test::translated(soup(5, 1), {1e7, 0, 0});
  MeshRequest request = fast(20);
  const BoundedMesh made = bound_mesh(far, request, coarse());
  ASSERT_EQ(made.series.meshes.size(), 1U);
  EXPECT_TRUE(made.wrap) << made.why_not_wrapped;
  EXPECT_TRUE(made.series.meshes[0].certificate().double_precision);
  EXPECT_EQ(made.surface_answer(), Answer::Verified);
  request.format = io::Format::Stl;
  EXPECT_TRUE(bound_mesh(far, request, coarse()).series.meshes.empty());
}

// What fills holes is wrapped as well, and is none of the input's triangles.
TEST(BoundMesh, WrapsCountTheInputsTriangles) {
  const Mesh input = test::merged(
      {bow_tie(), test::without(test::icosphere(1), [](const Vec3& p) { return p.z() > 0.9; })});
  const BoundedMesh made = bound_mesh(input, fast(20), coarse());
  ASSERT_TRUE(made.wrap);
  EXPECT_EQ(made.wrap->input_triangles, input.triangles.size());
}

TEST(BoundMesh, SegmentsAreWrapped) {
  Mesh segments;
  for (const auto& [x, y, z] : {std::array{0., 0., 0.},
                                {1., 0., 0.},
                                {2., 0., 0.},
                                {0., 1., 1.},
                                {1., 1., 2.},
                                {2., 1., 3.}})
    segments.vertices.emplace_back(x, y, z);
  segments.triangles = {{0, 1, 2}, {3, 4, 5}};
  SetRequest request;
  request.epsilon = kaboum::Length{5, true};
  request.effort = bcd::Effort::Fast;
  request.wrap.emplace().where_needed = true;
  request.preparation.holes = geom::Holes::Fill;
  const auto made = certify_set(segments, "", request);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->certificate().wrap);
  request.wrap.reset();
  try {
    certify_set(segments, "", request);
    ADD_FAILURE() << "a set of segments";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput) << error.what();
  }
}

TEST(Float32Shortage, ItsRemedyHelps) {
  const auto box = [](double at, double size) {
    return geom::Box3{Vec3::Constant(at), Vec3::Constant(at + size)};
  };
  EXPECT_FALSE(too_coarse(box(0, 1), 1e-3));
  for (const double at : {0.0, 10.0, 1e3, 1e6})
    for (const double epsilon : {1e-1, 1e-4, 1e-7, 1e-9}) {
      SCOPED_TRACE(std::to_string(at) + " " + std::to_string(epsilon));
      const auto shortage = too_coarse(box(at, 1), epsilon);
      if (!shortage) continue;
      const std::string remedy = remedy_of(*shortage);
      const bool move = remedy.find("origin") != std::string::npos;
      EXPECT_TRUE(move || shortage->least_epsilon > 0) << remedy;
      if (move && remedy.find("larger epsilon") == std::string::npos) {
        EXPECT_FALSE(too_coarse(box(-0.5, 1), epsilon)) << remedy;
      }
      const std::size_t least = remedy.find("at least ");
      if (least != std::string::npos) {
        EXPECT_FALSE(too_coarse(box(at, 1), std::stod(remedy.substr(least + 9)))) << remedy;
      }
    }
}

TEST(LargeEpsilon, IsWarnedOf) {
  EXPECT_TRUE(warning_of({}, 2).empty());
  EXPECT_TRUE(warning_of(kaboum::Length{49, true}, 2).empty());
  EXPECT_TRUE(warning_of(kaboum::Length{0.9, false}, 2).empty());
  EXPECT_NE(warning_of(kaboum::Length{95, true}, 2).find("only 2 from corner to corner (95%)"),
            std::string::npos);
  EXPECT_FALSE(warning_of(kaboum::Length{1, false}, 2).empty());
}

}  // namespace
}  // namespace kaboum::certify
