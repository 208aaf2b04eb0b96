// Shells that touch, share walls or lie in each other, in all combinations of orientation: what any
// of them encloses is in the solid, unless it is a cavity.
#include <kaboum/base/error.h>
#include <kaboum/geom/preparation_doubt.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/winding.h>

#include <gtest/gtest.h>

#include <functional>
#include <numeric>
#include <random>
#include <sstream>

#include "support/oracle.h"
#include "support/shapes.h"

namespace {

using kaboum::geom::Holes;
using kaboum::geom::Mesh;
using kaboum::geom::prepare;
using kaboum::geom::Prepared;
using kaboum::geom::PrepareOptions;
using kaboum::geom::Triangle;
using kaboum::geom::Vec3;

struct Box {
  Vec3 lo, hi;
  bool inward = false;

  [[nodiscard]] bool holds(const Vec3& p) const {
    return (p.array() > lo.array()).all() && (p.array() < hi.array()).all();
  }
  [[nodiscard]] bool holds_strictly(const Box& b) const { return holds(b.lo) && holds(b.hi); }
};

/// A box whose faces are grids of the given coordinates, so that boxes that share some of them
/// share triangles. `other` takes the other diagonal of every square.
Mesh mesh_of(const Box& box, const std::vector<double>& lines, bool other = false) {
  Mesh mesh;
  std::array<std::vector<double>, 3> grid;
  for (int k = 0; k < 3; ++k) {
    grid[k] = {box.lo[k]};
    for (const double x : lines)
      if (x > box.lo[k] && x < box.hi[k]) grid[k].push_back(x);
    grid[k].push_back(box.hi[k]);
  }
  for (int k = 0; k < 3; ++k) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    for (const bool high : {false, true}) {
      for (std::size_t i = 0; i + 1 < grid[u].size(); ++i) {
        for (std::size_t j = 0; j + 1 < grid[v].size(); ++j) {
          const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
          for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
            Vec3 p;
            p[k] = high ? box.hi[k] : box.lo[k];
            p[u] = grid[u][a];
            p[v] = grid[v][b];
            mesh.vertices.push_back(p);
          }
          for (Triangle t : other ? std::array<Triangle, 2>{{{0, 1, 3}, {1, 2, 3}}}
                                  : std::array<Triangle, 2>{{{0, 1, 2}, {0, 2, 3}}}) {
            if (high == box.inward) std::swap(t[1], t[2]);
            mesh.triangles.push_back({n + t[0], n + t[1], n + t[2]});
          }
        }
      }
    }
  }
  return mesh;
}

Mesh shuffled(Mesh mesh, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  for (Triangle& t : mesh.triangles)
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
  return mesh;
}

Vec3 turned(const Vec3& p, double angle) {
  return kaboum::test::rotated(Mesh{{p}, {}}, angle).vertices[0];
}

/// A point in every cell of the unit grid, on no box.
std::vector<Vec3> points(const std::vector<Box>& boxes) {
  kaboum::geom::Box3 all;
  for (const Box& b : boxes) {
    all.extend(b.lo);
    all.extend(b.hi);
  }
  std::vector<Vec3> out;
  for (double x = std::floor(all.min.x()) - 0.63; x < all.max.x() + 1; ++x)
    for (double y = std::floor(all.min.y()) + 0.43; y < all.max.y(); ++y)
      for (double z = std::floor(all.min.z()) + 0.31; z < all.max.z(); ++z)
        out.emplace_back(x, y, z);
  return out;
}

/// Prepares in several orders and rotations and compares with what is meant.
void expect_solid(const std::string& name, const std::vector<Box>& boxes,
                  const std::vector<double>& lines, const std::function<bool(const Vec3&)>& meant,
                  int other = -1) {
  std::vector<Mesh> parts;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    parts.push_back(mesh_of(boxes[i], lines, static_cast<int>(i) == other));
  const Mesh file = kaboum::test::merged(parts);
  for (const auto& [mesh, angle] : {std::pair{file, 0.0},
                                    {shuffled(file, 1), 0.0},
                                    {kaboum::test::rotated(shuffled(file, 2), 0.7), 0.7}}) {
    Prepared p;
    try {
      p = prepare(mesh);
    } catch (const kaboum::Error& e) {
      ADD_FAILURE() << name << ": " << e.what();
      return;
    }
    ASSERT_TRUE(p.solid.closed()) << name;
    for (const Vec3& x : points(boxes)) {
      const auto w =
          kaboum::test::winding_number_slow(p.solid.mesh(), angle == 0 ? x : turned(x, angle));
      ASSERT_TRUE(w.has_value()) << name;
      EXPECT_EQ(*w >= 1, meant(x))
          << name << ", angle " << angle << " at " << x.transpose() << ": " << *w;
      EXPECT_GE(*w, 0) << name;
    }
    if (testing::Test::HasFailure()) return;
  }
}

/// In all combinations of orientation: the union.
void expect_union(const std::string& name, std::vector<Box> boxes, const std::vector<double>& lines,
                  int other = -1) {
  for (unsigned signs = 0; signs < 1U << boxes.size(); ++signs) {
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].inward = (signs >> i & 1U) != 0;
    expect_solid(
        name + ", signs " + std::to_string(signs), boxes, lines,
        [&](const Vec3& x) {
          return std::any_of(boxes.begin(), boxes.end(), [&](const Box& b) { return b.holds(x); });
        },
        other);
    if (testing::Test::HasFailure()) return;
  }
}

const std::vector<double> kUnits{0, 1, 2, 3, 4, 5};

TEST(Shells, TwoBoxesShareAWall) {
  expect_union("equal", {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}}, kUnits);
  expect_union("longer", {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {4, 1, 1}}}, kUnits);
  expect_union("wall of four squares", {{{0, 0, 0}, {1, 2, 2}}, {{1, 0, 0}, {2, 2, 2}}}, kUnits);
}

TEST(Shells, WallsDoubledInPart) {
  expect_union("in the middle", {{{0, 0, 0}, {1, 3, 3}}, {{1, 1, 1}, {2, 2, 2}}}, kUnits);
  expect_union("at a corner", {{{0, 0, 0}, {1, 3, 3}}, {{1, 0, 0}, {2, 2, 2}}}, kUnits);
  expect_union("both stick out", {{{0, 0, 0}, {1, 2, 2}}, {{1, 1, 1}, {2, 3, 3}}}, kUnits);
}

TEST(Shells, RowsAndBlocks) {
  expect_union("row", {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}},
               kUnits);
  expect_union("two by two",
               {{{0, 0, 0}, {1, 1, 1}},
                {{1, 0, 0}, {2, 1, 1}},
                {{0, 1, 0}, {1, 2, 1}},
                {{1, 1, 0}, {2, 2, 1}}},
               kUnits);
}

TEST(Shells, WallsTriangulatedDifferently) {
  expect_union("equal", {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}}, kUnits, 1);
  expect_union("row", {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}},
               kUnits, 1);
  expect_union("in part", {{{0, 0, 0}, {1, 2, 2}}, {{1, 0, 0}, {2, 1, 2}}}, kUnits, 1);
  expect_union("a line more", {{{0, 0, 0}, {1, 2, 2}}, {{1, 0, 0}, {2, 2, 2}}}, {0, 2});
}

TEST(Shells, JoinedAtAnEdgeOrVertex) {
  expect_union("edge", {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 0}, {2, 2, 1}}}, kUnits);
  expect_union("vertex", {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}}, kUnits);
  expect_union("edges in a block",
               {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 0}, {2, 2, 1}}, {{1, 0, 0}, {2, 1, 1}}}, kUnits);
}

TEST(Shells, BoxesCross) {
  expect_union("corner", {{{0, 0, 0}, {2, 2, 2}}, {{1, 1, 1}, {3, 3, 3}}}, {});
  expect_union("through", {{{0, 0, 0}, {3, 3, 3}}, {{-1, 1, 1}, {4, 2, 2}}}, {});
  expect_union("coplanar sides", {{{0, 0, 0}, {2, 2, 2}}, {{1, 0, 0}, {3, 2, 2}}}, {});
}

TEST(Shells, Copies) {
  expect_union("both alike", {{{0, 0, 0}, {1, 1, 1}, false}}, kUnits);
  for (const bool inward : {false, true}) {
    const Box box{{0, 0, 0}, {2, 2, 2}, inward}, beside{{2, 0, 0}, {3, 2, 2}, !inward};
    expect_solid("copies", {box, box}, kUnits, [&](const Vec3& x) { return box.holds(x); });
    expect_solid("copies beside another", {box, box, beside}, kUnits,
                 [&](const Vec3& x) { return box.holds(x) || beside.holds(x); });
  }
}

// All corners of the bar lie in the other's solid, a part does not.
TEST(Shells, ABarInsideOutAcrossANotch) {
  for (const bool flush : {false, true}) {
    const double top = flush ? 3 : 2.5;
    const Box left{{0, 0, 0}, {1, 3, 3}}, bottom{{1, 0, 0}, {3, 3, 1}}, right{{3, 0, 0}, {4, 3, 3}},
        bar{{0.5, 1, 1.5}, {3.5, 2, top}, true};
    expect_solid("notch", {left, bottom, right, bar}, {1, 3}, [&](const Vec3& x) {
      return left.holds(x) || bottom.holds(x) || right.holds(x) || bar.holds(x);
    });
  }
}

TEST(Shells, CavitiesStay) {
  const Box body{{0, 0, 0}, {5, 5, 5}}, cavity{{1, 1, 1}, {4, 4, 4}, true};
  const auto shell = [&](const Vec3& x) { return body.holds(x) && !cavity.holds(x); };
  expect_solid("cavity", {body, cavity}, {2, 3}, shell);
  const Box piece{{2, 2, 2}, {3, 3, 3}, true}, right{{2, 2, 2}, {3, 3, 3}};
  for (const Box& b : {piece, right})
    expect_solid("a body within", {body, cavity, b}, {2, 3},
                 [&](const Vec3& x) { return shell(x) || b.holds(x); });
  // A body inside out at the cavity's wall.
  const Box at_wall{{1, 2, 2}, {2, 3, 3}, true};
  expect_solid("a body at the wall", {body, cavity, at_wall}, {2, 3},
               [&](const Vec3& x) { return shell(x) || at_wall.holds(x); });
  // Two cavities that touch in an edge, and in a corner.
  const Box a{{1, 1, 1}, {2, 2, 2}, true}, b{{2, 2, 1}, {3, 3, 2}, true},
      c{{3, 3, 2}, {4, 4, 3}, true};
  expect_solid("touching cavities", {body, a, b, c}, {2, 3}, [&](const Vec3& x) {
    return body.holds(x) && !a.holds(x) && !b.holds(x) && !c.holds(x);
  });
  // The cavity of a body that shares a wall with another one.
  const Box beside{{5, 0, 0}, {6, 5, 5}, true};
  expect_solid("beside another", {body, cavity, beside}, {2, 3},
               [&](const Vec3& x) { return shell(x) || beside.holds(x); });
}

TEST(Shells, FilesInsideOutAsAWhole) {
  const Box body{{0, 0, 0}, {5, 5, 5}, true}, cavity{{1, 1, 1}, {4, 4, 4}},
      beside{{5, 0, 0}, {6, 5, 5}, true};
  expect_solid("with a cavity", {body, cavity, beside}, {2, 3}, [&](const Vec3& x) {
    return (body.holds(x) && !cavity.holds(x)) || beside.holds(x);
  });
  // Not if that would take from a solid within.
  const Box piece{{2, 2, 2}, {3, 3, 3}};
  expect_solid("round two bodies", {body, cavity, piece}, {},
               [&](const Vec3& x) { return body.holds(x); });
}

// The hole is closed before orientation is judged.
TEST(Shells, OpenPartsAreFilledFirst) {
  for (const bool inward : {false, true}) {
    for (const bool beside : {false, true}) {
      const Box box{{0, 0, 0}, {2, 2, 2}, inward}, closed{{2, 0, 0}, {4, 2, 2}};
      Mesh mesh = mesh_of(box, kUnits);
      mesh = kaboum::test::without(mesh, [](const Vec3& p) { return p.x() == 2; });
      if (beside) mesh = kaboum::test::merged({mesh, mesh_of(closed, kUnits)});
      PrepareOptions fill;
      fill.holes = Holes::Fill;
      const Prepared p = prepare(mesh, fill);
      ASSERT_TRUE(p.solid.closed());
      EXPECT_EQ(p.report.holes, 1U);
      EXPECT_EQ(p.solid.filled_triangles(), 8U);
      EXPECT_EQ(p.report.filled_vertices, beside ? 0U : 1U) << "the middle of the other box's wall";
      EXPECT_NEAR(p.report.largest_hole, std::sqrt(8), 1e-9);
      EXPECT_EQ(p.report.source.size() + p.solid.filled_triangles(),
                p.solid.mesh().triangles.size());
      EXPECT_EQ(p.report.reversed_components, inward ? 1U : 0U);
      for (const Vec3& x : points({box, closed})) {
        EXPECT_EQ(*kaboum::test::winding_number_slow(p.solid.mesh(), x) >= 1,
                  box.holds(x) || (beside && closed.holds(x)));
      }
    }
  }
}

// A body that was closed loses nothing to a part that was open: what is filled is no cavity.
TEST(Shells, FilledPartsAreNoCavities) {
  const Box outer{{0, 0, 0}, {5, 5, 5}};
  for (const bool inward : {false, true}) {
    const Box inner{{1, 1, 1}, {3, 3, 3}, inward};
    const Mesh open =
        kaboum::test::without(mesh_of(inner, kUnits), [](const Vec3& p) { return p.z() == 3; });
    PrepareOptions fill;
    fill.holes = Holes::Fill;
    const Prepared p = prepare(kaboum::test::merged({mesh_of(outer, kUnits), open}), fill);
    ASSERT_TRUE(p.solid.closed());
    for (const Vec3& x : points({outer}))
      EXPECT_EQ(*kaboum::test::winding_number_slow(p.solid.mesh(), x) >= 1, outer.holds(x));
  }
}

bool notes_hollow(const Prepared& p) {
  return std::any_of(p.report.notes.begin(), p.report.notes.end(), [](const std::string& note) {
    return note.find("counts as outside") != std::string::npos;
  });
}

// Two open boxes, both outward, share one edge of their rims. Turning one of them to agree at that
// edge would hollow it, and the closed body that it lies in.
TEST(Shells, OpenBodiesThatShareAnEdgeAreNotTurnedAgainstEachOther) {
  Mesh mesh;
  mesh.vertices = {{0, 1, 1}, {0, 3, 1}, {1, 3, 1}, {1, 1, 1}, {0, 1, 2}, {1, 1, 2}, {1, 3, 2},
                   {0, 3, 2}, {0, 0, 3}, {1, 0, 3}, {1, 1, 3}, {0, 1, 3}, {0, 0, 1}, {1, 0, 1}};
  mesh.triangles = {{0, 1, 2},  {0, 2, 3},   {4, 5, 6},   {4, 6, 7},   {1, 7, 6},
                    {1, 6, 2},  {0, 4, 7},   {0, 7, 1},   {3, 2, 6},   {3, 6, 5},
                    {8, 9, 10}, {8, 10, 11}, {12, 13, 9}, {12, 9, 8},  {0, 11, 10},
                    {0, 10, 3}, {12, 8, 11}, {12, 11, 0}, {13, 3, 10}, {13, 10, 9}};
  PrepareOptions fill;
  fill.holes = Holes::Fill;
  EXPECT_THROW(prepare(mesh, fill), kaboum::Error);
  const Box round{{-1, -1, -1}, {4, 4, 4}};
  EXPECT_THROW(prepare(kaboum::test::merged({mesh_of(round, kUnits), mesh}), fill), kaboum::Error);
}

// Two rooms with one wall between them, there once, and a floor of the first one missing: the
// hole's rim runs along the wall. Which room it opens depends on how the wall is oriented.
TEST(Shells, AHoleAtASharedWallIsRefusedOrSaid) {
  const auto rooms = [](bool wall_of_first) {
    Mesh mesh;  // 4 × 2 × 2 corners, of x = 0, 1, 2
    for (const double x : {0.0, 1.0, 2.0})
      for (const double y : {0.0, 1.0})
        for (const double z : {0.0, 1.0}) mesh.vertices.emplace_back(x, y, z);
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    };
    quad(0, 1, 3, 2);                                    // x = 0
    quad(8, 10, 11, 9);                                  // x = 2
    for (const std::uint32_t first : {0U, 4U}) {         // of each room
      quad(first, first + 4, first + 5, first + 1);      // y = 0
      quad(first + 2, first + 3, first + 7, first + 6);  // y = 1
      quad(first + 1, first + 5, first + 7, first + 3);  // z = 1
    }
    quad(4, 6, 10, 8);  // z = 0, of the second room only
    if (wall_of_first)
      quad(4, 6, 7, 5);
    else
      quad(4, 5, 7, 6);
    return mesh;
  };
  PrepareOptions fill;
  fill.holes = Holes::Fill;
  EXPECT_THROW(prepare(rooms(true), fill), kaboum::Error);
  const Prepared p = prepare(rooms(false), fill);
  EXPECT_TRUE(
      std::any_of(p.report.notes.begin(), p.report.notes.end(), [](const std::string& note) {
        return note.find("rim runs along a wall") != std::string::npos;
      }));
  EXPECT_TRUE(p.report.guessed);
  EXPECT_FALSE(doubt_about(p.report).empty());
  Mesh plain = kaboum::test::box({1, 1, 1}, 1);  // a hole by itself is no guess
  plain.triangles.pop_back();
  const Prepared open = prepare(plain, fill);
  EXPECT_EQ(open.report.holes, 1U);
  EXPECT_FALSE(open.report.guessed);
  EXPECT_TRUE(doubt_about(open.report).empty());
}

/// A prism over a bow tie: the smaller one of its lobes is inside out.
Mesh bow_tie() {
  Mesh mesh;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {4.0, 3.0}, {4.0, 0.0}, {0.0, 1.0}})
      mesh.vertices.emplace_back(x, y, z);
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t n = (k + 1) % 4;
    mesh.triangles.push_back({k, n, n + 4});
    mesh.triangles.push_back({k, n + 4, k + 4});
  }
  mesh.triangles.insert(mesh.triangles.end(), {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}});
  return mesh;
}

// A closed surface that crosses itself, most of it oriented outwards: two boxes as one, joined
// through a neck along which it turns inside out.
TEST(Shells, ALobeInsideOutIsNoted) {
  const Prepared p = prepare(bow_tie());
  EXPECT_TRUE(p.solid.closed());
  EXPECT_TRUE(notes_hollow(p));
}

// Within a box a lobe that is inside out takes from the box's solid: w = 0 there, as in a cavity.
TEST(Shells, ALobeInsideOutWithinABoxIsNoted) {
  Mesh turned = bow_tie();
  for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
  const auto moved = [](Mesh mesh) {
    for (Vec3& v : mesh.vertices) v += Vec3(3, 4, 2);
    return mesh;
  };
  const Mesh box = mesh_of({{0, 0, 0}, {10, 10, 10}}, {}, false);
  for (const Mesh& bow : {bow_tie(), turned}) {
    const Prepared p = prepare(kaboum::test::merged({box, moved(bow)}));
    EXPECT_TRUE(notes_hollow(p));
    ASSERT_TRUE(p.report.hollow);
    const auto w = kaboum::test::winding_number_slow(p.solid.mesh(), *p.report.hollow);
    EXPECT_EQ(w.value_or(9), 0);
    EXPECT_FALSE(doubt_about(p.report).empty());
  }
  // Twice within: the solid holds the lobe all the same.
  const Mesh inner = mesh_of({{1, 1, 1}, {9, 9, 9}}, {}, false);
  EXPECT_FALSE(notes_hollow(prepare(kaboum::test::merged({box, inner, moved(bow_tie())}))));
  // A cavity is none.
  const Mesh cavity = mesh_of({{1, 1, 1}, {9, 9, 9}, true}, {}, false);
  EXPECT_FALSE(notes_hollow(prepare(kaboum::test::merged({box, cavity}))));
}

// Walls of boxes without common grids lie in each other in part: what stays inside out is refused
// or noted, whatever the boxes.
TEST(Shells, WhatStaysInsideOutIsSaid) {
  std::mt19937 random(11);
  const auto random_box = [&] {
    Box box;
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = static_cast<double>(random() % 3);
      box.hi[k] = box.lo[k] + 1 + static_cast<double>(random() % 2);
    }
    box.inward = random() % 2 == 0;
    return box;
  };
  std::vector<std::pair<std::vector<Box>, std::uint32_t>> cases{
      {{{{2, 1, 1}, {3, 2, 3}}, {{1, 1, 1}, {3, 2, 2}, true}, {{2, 1, 1}, {3, 2, 2}}}, 1}};
  for (int i = 0; i < 300; ++i)
    cases.push_back(
        {{random_box(), random_box(), random_box()}, static_cast<std::uint32_t>(random() % 8)});
  for (const auto& [boxes, diagonals] : cases) {
    std::vector<Mesh> parts;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      parts.push_back(mesh_of(boxes[i], {}, (diagonals >> i & 1U) != 0));
    Prepared p;
    try {
      p = prepare(kaboum::test::merged(parts));
    } catch (const kaboum::Error&) {
      continue;
    }
    for (const Vec3& x : points(boxes)) {
      const auto w = kaboum::test::winding_number_slow(p.solid.mesh(), x);
      ASSERT_TRUE(w.has_value());
      EXPECT_TRUE(*w >= 0 || notes_hollow(p)) << *w << " at " << x.transpose();
    }
  }
}

/// Whether a point is in the solid that is meant: a box holds it, and it may not count as hollow.
/// It may if every box that holds it is a cavity there, or has one: strictly inside, and oriented
/// the other way.
bool meant(const std::vector<Box>& boxes, const Vec3& x) {
  bool held = false, hollow = true;
  for (const Box& b : boxes) {
    if (!b.holds(x)) continue;
    held = true;
    hollow =
        hollow && std::any_of(boxes.begin(), boxes.end(), [&](const Box& c) {
          return c.holds(x) && c.inward != b.inward && (c.holds_strictly(b) || b.holds_strictly(c));
        });
  }
  return held && !hollow;
}

enum class Answer { Right, Noted, Refused, Silent };

/// Whether all that is meant is enclosed, or it is said that it is not.
Answer answer(const std::vector<Box>& boxes, const Mesh& mesh) {
  Prepared p;
  try {
    p = prepare(mesh);
  } catch (const kaboum::Error&) {
    return Answer::Refused;
  }
  const kaboum::geom::WindingNumber winding(p.solid.mesh());
  for (const Vec3& x : points(boxes)) {
    const int w = winding(x).value();
    if (w >= 0 && (w >= 1 || !meant(boxes, x))) continue;
    return notes_hollow(p) ? Answer::Noted : Answer::Silent;
  }
  return Answer::Right;
}

// An inward box in an outward one, with a common wall: as well a notch with a sheet before it.
TEST(Shells, AnInwardBoxAtAWallIsNotHollowedSilently) {
  const std::vector<Box> boxes{{{3, 0, 3}, {4, 2, 4}}, {{3, 0, 3}, {4, 1, 4}, true}};
  for (const bool same : {false, true}) {
    const Mesh mesh = kaboum::test::merged({mesh_of(boxes[0], {}), mesh_of(boxes[1], {}, !same)});
    try {
      prepare(mesh);
      ADD_FAILURE() << "same diagonals: " << same;
    } catch (const kaboum::Error& e) {
      EXPECT_NE(std::string(e.what()).find(same ? "sheets" : "share a wall"), std::string::npos)
          << e.what();
    }
  }
}

// The wall of three: with a body beyond it, the hollow lies between bodies.
TEST(Shells, AnInwardBoxAtAWallOfTwoBodies) {
  const std::vector<Box> boxes{
      {{0, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {2, 1, 1}, true}, {{2, 0, 0}, {3, 1, 1}}};
  for (unsigned diagonals = 0; diagonals < 8; ++diagonals) {
    std::vector<Mesh> parts;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      parts.push_back(mesh_of(boxes[i], {}, (diagonals >> i & 1U) != 0));
    EXPECT_NE(answer(boxes, kaboum::test::merged(parts)), Answer::Silent) << diagonals;
  }
}

// What is left of two boxes once levels are taken off is one patch, and winds both ways.
TEST(Shells, APieceOfOnePatchThatWindsBothWays) {
  const std::vector<Box> boxes{
      {{2, 0, 1}, {4, 3, 4}, true}, {{3, 2, 0}, {4, 3, 4}}, {{3, 1, 2}, {4, 4, 3}, true}};
  const Mesh mesh = kaboum::test::merged(
      {mesh_of(boxes[0], {}), mesh_of(boxes[1], {1, 2}), mesh_of(boxes[2], {2, 3})});
  for (std::uint32_t seed = 0; seed < 4; ++seed)
    EXPECT_NE(answer(boxes, shuffled(mesh, seed)), Answer::Silent);
}

// A hollow between bodies that nobody's shell encloses is noted, if walls do not tell it to be one;
// bodies that enclose none are not.
TEST(Shells, NoFalseAlarms) {
  const std::vector<Box> boxes{{{0, 0, 0}, {1, 3, 3}},
                               {{2, 0, 0}, {3, 3, 3}},
                               {{1, 0, 0}, {2, 1, 3}},
                               {{1, 2, 0}, {2, 3, 3}}};
  for (const bool other : {false, true}) {
    std::vector<Mesh> parts;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      parts.push_back(mesh_of(boxes[i], kUnits, other && i > 1));
    const Prepared p = prepare(kaboum::test::merged(parts));
    EXPECT_FALSE(notes_hollow(p)) << "a ring";
    parts.push_back(mesh_of({{1, 1, 0}, {2, 2, 1}}, kUnits));
    parts.push_back(mesh_of({{1, 1, 2}, {2, 2, 3}}, kUnits));
    const Prepared box = prepare(kaboum::test::merged(parts));
    EXPECT_TRUE(notes_hollow(box)) << "a box";
  }
}

// Random boxes: faces cut at no, all or some lines, any diagonals.
TEST(Shells, RandomBoxesAreEnclosedOrRefusedOrNoted) {
  std::mt19937 random(20);
  std::array<int, 4> counts{};
  for (int i = 0; i < 2500; ++i) {
    const int range = 3 + static_cast<int>(random() % 2);
    std::vector<Box> boxes(2 + random() % 4);
    std::vector<Mesh> parts;
    const auto cuts = random() % 3;
    for (Box& b : boxes) {
      for (int k = 0; k < 3; ++k) {
        const auto lo = static_cast<int>(random() % static_cast<unsigned>(range));
        b.lo[k] = lo;
        b.hi[k] = lo + 1 + static_cast<int>(random() % static_cast<unsigned>(range - lo));
      }
      b.inward = random() % 2 == 0;
      std::vector<double> lines;
      for (int x = 0; x < range; ++x)
        if (cuts == 1 || (cuts == 2 && random() % 2 == 0)) lines.push_back(x);
      parts.push_back(mesh_of(b, lines, random() % 2 == 0));
    }
    const Answer a = answer(boxes, kaboum::test::merged(parts));
    ++counts[static_cast<std::size_t>(a)];
    if (a != Answer::Silent) continue;
    std::string text;
    for (const Box& b : boxes) {
      std::ostringstream s;
      s << " (" << b.lo.transpose() << ")-(" << b.hi.transpose() << ")"
        << (b.inward ? " inward" : "");
      text += s.str();
    }
    ADD_FAILURE() << "round " << i << ", cuts " << cuts << ":" << text;
  }
  EXPECT_GT(counts[0], 1500);
}

}  // namespace
