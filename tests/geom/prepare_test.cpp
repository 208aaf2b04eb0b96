#include <kaboum/base/error.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <gtest/gtest.h>

#include "support/families.h"

namespace {

using kaboum::Error;
using kaboum::ErrorCode;
using kaboum::geom::Mesh;
using kaboum::geom::prepare;
using kaboum::geom::Prepared;
using kaboum::geom::PrepareOptions;
using kaboum::geom::Vec3;

/// Axis-aligned cube [lo, hi]³, outward, or inward when `inward`.
void add_cube(Mesh& mesh, Vec3 lo, Vec3 hi, bool inward = false) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? hi.x() : lo.x(), (i & 2) != 0 ? hi.y() : lo.y(),
                               (i & 4) != 0 ? hi.z() : lo.z());
  const std::uint32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                      {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                      {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& f : faces)
    mesh.triangles.push_back(inward
                                 ? kaboum::geom::Triangle{base + f[0], base + f[2], base + f[1]}
                                 : kaboum::geom::Triangle{base + f[0], base + f[1], base + f[2]});
}

int winding_at(const Prepared& p, const Vec3& x) {
  return kaboum::geom::WindingNumber(p.solid.mesh())(x).value();
}

ErrorCode refusal(const Mesh& mesh, const PrepareOptions& options = {}) {
  try {
    prepare(mesh, options);
  } catch (const Error& e) {
    EXPECT_GT(std::string(e.what()).size(), 20U);
    return e.code();
  }
  ADD_FAILURE() << "not refused";
  return ErrorCode::Internal;
}

TEST(Prepare, LeavesAGoodMeshAlone) {
  Mesh cube;
  add_cube(cube, {0, 0, 0}, {1, 1, 1});
  const Prepared p = prepare(cube);
  EXPECT_TRUE(p.solid.closed());
  EXPECT_EQ(p.solid.mesh().triangles.size(), 12U);
  EXPECT_TRUE(p.report.notes.empty());
  EXPECT_EQ(p.report.components, 1U);
}

TEST(Prepare, TurnsAnInsideOutComponent) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {1, 1, 1}, true);
  add_cube(mesh, {2, 0, 0}, {3, 1, 1});
  const Prepared p = prepare(mesh);
  EXPECT_EQ(p.report.reversed_components, 1U);
  EXPECT_EQ(p.report.reversed_triangles, 12U);
  EXPECT_EQ(winding_at(p, {0.5, 0.5, 0.5}), 1);
  EXPECT_EQ(winding_at(p, {2.5, 0.5, 0.5}), 1);
  PrepareOptions keep;
  keep.keep_orientation = true;
  EXPECT_EQ(winding_at(prepare(mesh, keep), {0.5, 0.5, 0.5}), -1);
}

TEST(Prepare, KeepsCavitiesAndBodiesInBodies) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {9, 9, 9});
  add_cube(mesh, {1, 1, 1}, {8, 8, 8}, true);              // cavity
  add_cube(mesh, {2, 2, 2}, {3, 3, 3});                    // a body in the cavity
  add_cube(mesh, {0.25, 0.25, 0.25}, {0.75, 0.75, 0.75});  // a body in the wall
  const Prepared p = prepare(mesh);
  EXPECT_EQ(p.report.reversed_triangles, 0U);
  EXPECT_EQ(winding_at(p, {5, 5, 5.5}), 0);
  EXPECT_EQ(winding_at(p, {2.5, 2.5, 2.25}), 1);
  EXPECT_EQ(winding_at(p, {0.5, 0.5, 0.375}), 2);
}

TEST(Prepare, TurnsAWholeNestThatIsInsideOut) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {9, 9, 9}, true);
  add_cube(mesh, {1, 1, 1}, {8, 8, 8});  // the cavity of the inverted file
  const Prepared p = prepare(mesh);
  EXPECT_EQ(winding_at(p, {0.5, 0.5, 0.25}), 1);
  EXPECT_EQ(winding_at(p, {5, 5, 5.5}), 0);
}

TEST(Prepare, TurnsAnInsideOutBodyInACavity) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {9, 9, 9});
  add_cube(mesh, {1, 1, 1}, {8, 8, 8}, true);
  add_cube(mesh, {2, 2, 2}, {3, 3, 3}, true);
  const Prepared p = prepare(mesh);
  EXPECT_EQ(p.report.reversed_components, 1U);
  EXPECT_EQ(winding_at(p, {2.5, 2.5, 2.25}), 1);
}

// A small inside-out body overlaps a corner of a big one, whose first corner lies inside it.
TEST(Prepare, TurnsOnlyWhatIsInsideOut) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {10, 10, 10});
  add_cube(mesh, {-1, -1, -1}, {1, 1, 1}, true);
  const Prepared p = prepare(mesh);
  EXPECT_EQ(p.report.reversed_triangles, 12U);
  EXPECT_EQ(winding_at(p, {5, 5, 5.5}), 1);
  EXPECT_EQ(winding_at(p, {-0.5, -0.5, -0.25}), 1);
  EXPECT_EQ(winding_at(p, {0.5, 0.5, 0.25}), 2);
}

// An inside-out shell around a solid body: the body keeps its solid.
TEST(Prepare, TakesNoSolidFromANest) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {9, 9, 9}, true);
  add_cube(mesh, {1, 1, 1}, {8, 8, 8});
  add_cube(mesh, {2, 2, 2}, {7, 7, 7});
  const Prepared p = prepare(mesh);
  EXPECT_GE(winding_at(p, {4, 4, 4.5}), 1);
  EXPECT_GE(winding_at(p, {0.5, 0.5, 0.25}), 1);
}

TEST(Prepare, KeepsCopiesBesideCavities) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {9, 9, 9});
  add_cube(mesh, {0, 0, 0}, {9, 9, 9});
  add_cube(mesh, {1, 1, 1}, {8, 8, 8}, true);  // 2 − 1 = 1: still solid
  const Prepared p = prepare(mesh);
  EXPECT_EQ(p.report.dropped_copies, 0U);
  EXPECT_EQ(winding_at(p, {5, 5, 5.5}), 1);
}

TEST(Prepare, RefusesSizesThatOverflow) {
  for (const double s : {1e70, 1e-70}) {
    Mesh mesh;
    add_cube(mesh, {0, 0, 0}, {s, s, s});
    EXPECT_EQ(refusal(mesh), ErrorCode::InvalidInput);
  }
}

TEST(Prepare, AgreesMixedOrientation) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {1, 1, 1});
  for (std::size_t t = 0; t < 12; t += 5) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const Prepared p = prepare(mesh);
  EXPECT_TRUE(p.solid.closed());
  EXPECT_EQ(p.report.reversed_triangles, 3U);
  EXPECT_EQ(winding_at(p, {0.5, 0.5, 0.5}), 1);
}

TEST(Prepare, DropsCopiesAndCancelsWalls) {
  Mesh twice;
  add_cube(twice, {0, 0, 0}, {1, 1, 1});
  add_cube(twice, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(prepare(twice).report.dropped_copies, 12U);
  // Judging each of so many shells among the others would take minutes.
  Mesh many;
  for (int i = 0; i < 20000; ++i) add_cube(many, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(prepare(many).report.dropped_copies, 12U * 19999);
  EXPECT_EQ(prepare(twice).solid.mesh().triangles.size(), 12U);

  Mesh stacked;  // two cubes with a common face, triangulated alike
  add_cube(stacked, {0, 0, 0}, {1, 1, 1});
  stacked.vertices.insert(stacked.vertices.end(), {{2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {2, 1, 1}});
  for (const auto& t : std::vector<kaboum::geom::Triangle>{{1, 5, 3},
                                                           {3, 5, 7},
                                                           {8, 9, 10},
                                                           {9, 11, 10},
                                                           {1, 3, 8},
                                                           {3, 9, 8},
                                                           {5, 10, 7},
                                                           {7, 10, 11},
                                                           {1, 8, 5},
                                                           {5, 8, 10},
                                                           {3, 7, 9},
                                                           {7, 11, 9}})
    stacked.triangles.push_back(t);
  const Prepared p = prepare(stacked);
  EXPECT_TRUE(p.solid.closed());
  EXPECT_EQ(p.report.cancelled_walls, 4U);
  EXPECT_EQ(winding_at(p, {1, 0.5, 0.25}), 1) << "the wall is gone";
}

TEST(Prepare, RefusesWhatHasNoSolid) {
  EXPECT_EQ(refusal(Mesh{}), ErrorCode::InvalidInput);
  Mesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_EQ(refusal(sheet), ErrorCode::InvalidInput);
  Mesh collapsed{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}};
  EXPECT_EQ(refusal(collapsed), ErrorCode::InvalidInput);
  Mesh nan{{{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}}, {{0, 1, 2}}};
  EXPECT_EQ(refusal(nan), ErrorCode::InvalidInput);
  Mesh range{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 7}}};
  EXPECT_EQ(refusal(range), ErrorCode::InvalidInput);

  // Möbius strip of seven quads.
  Mesh strip;
  for (int i = 0; i < 7; ++i) {
    const double u = 2 * M_PI * i / 7;
    for (const double s : {-0.3, 0.3})
      strip.vertices.emplace_back((1 + s * std::cos(u / 2)) * std::cos(u),
                                  (1 + s * std::cos(u / 2)) * std::sin(u), s * std::sin(u / 2));
  }
  for (std::uint32_t i = 0; i < 7; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1;
    const std::uint32_t c = i == 6 ? 1 : a + 2, d = i == 6 ? 0 : a + 3;
    strip.triangles.push_back({a, c, b});
    strip.triangles.push_back({b, c, d});
  }
  EXPECT_EQ(refusal(strip), ErrorCode::InvalidInput);
}

TEST(Prepare, KeepsTheBorderOfOpenMeshes) {
  Mesh open;
  add_cube(open, {0, 0, 0}, {1, 1, 1});
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2);  // no bottom
  const Prepared p = prepare(open);
  EXPECT_FALSE(p.solid.closed());
  int border = 0;
  for (std::size_t v = 0; v < p.solid.mesh().vertices.size(); ++v) {
    border += p.solid.border()[v];
    EXPECT_EQ(p.solid.border()[v] != 0, p.solid.mesh().vertices[v].z() == 0);
  }
  EXPECT_EQ(border, 4);
  PrepareOptions strict;
  strict.holes = kaboum::geom::Holes::Refuse;
  EXPECT_EQ(refusal(open, strict), ErrorCode::InvalidInput);
}

TEST(Prepare, DropsSheetsOnRequestOnly) {
  Mesh mesh;
  add_cube(mesh, {0, 0, 0}, {1, 1, 1});
  mesh.vertices.insert(mesh.vertices.end(), {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
  mesh.triangles.push_back({8, 9, 10});
  mesh.triangles.push_back({8, 10, 9});
  EXPECT_EQ(refusal(mesh), ErrorCode::InvalidInput);
  PrepareOptions drop;
  drop.drop_sheets = true;
  EXPECT_EQ(prepare(mesh, drop).report.dropped_sheets, 2U);
  EXPECT_EQ(prepare(mesh, drop).solid.mesh().triangles.size(), 12U);
}

}  // namespace
