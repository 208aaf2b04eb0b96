// Triangles without area are the segments and points that they are: in the outer solid or not, by
// exact answers; and nothing is said to be enclosed where there is nothing.
#include <gtest/gtest.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/mesh_verdict.h>

#include <random>

#include "judge.h"
#include "pairs.h"
#include "support/segment_oracle.h"
#include "support/shapes.h"

namespace kaboum::verify {
namespace {

using geom::Mesh;
using geom::Vec3;

Mesh segment(const Vec3& p, const Vec3& q) { return {{p, 0.5 * (p + q), q}, {{0, 1, 2}}}; }

/// The same set of points, as (a, b, b) and the like.
Mesh repeated(const Vec3& p, const Vec3& q, int k) {
  const std::array<geom::Triangle, 3> kOrders{{{0, 1, 1}, {0, 0, 1}, {0, 1, 0}}};
  return {{p, q}, {kOrders[static_cast<std::size_t>(k) % 3]}};
}

MeshVerdict decided(const Mesh& original, const Mesh& approximation, Claims claims = Claims::All) {
  return decide({original, approximation, nullptr, Relation::Outer, claims});
}

TEST(WithoutArea, NothingIsEnclosedByNothing) {
  const Mesh box = test::box({1, 1, 1}, 1);
  const Mesh empty, points{{{0.5, 0.5, 0.5}, {9, 9, 9}}, {}};
  for (const Mesh* nothing : {&empty, &points}) {
    for (const Claims claims : {Claims::All, Claims::Solid, Claims::Surface}) {
      EXPECT_EQ(decided(*nothing, box, claims).answer, Answer::Undefined);
      EXPECT_EQ(decided(*nothing, *nothing, claims).answer, Answer::Undefined);
      EXPECT_EQ(decided(box, *nothing, claims).answer, Answer::Refuted);
    }
    const Cover cover = verify_cover(*nothing, {.bodies = {{"box", box}}, .provenance = {}});
    EXPECT_EQ(cover.inclusion.solid.answer, Answer::Undefined);
    EXPECT_EQ(cover.inclusion.surface.answer, Answer::Undefined);
    EXPECT_EQ(verify_distance(*nothing, box, 1).answer, Answer::Undefined);
  }
  // A set without bodies covers nothing, but of a mesh there is something to cover.
  EXPECT_EQ(verify_cover(box, {}).inclusion.surface.answer, Answer::Refuted);
}

TEST(WithoutArea, SegmentsAndPointsStickOutOrNot) {
  const Mesh box = test::box({1, 1, 1}, 1);
  struct Case {
    Vec3 p, q;
    bool in;
  };
  const double next = std::nextafter(1.0, 2.0);
  const std::vector<Case> cases{
      {{0.5, 0.5, 0.5}, {5, 0.5, 0.5}, false},      // one end outside
      {{0.25, 0.5, 0.5}, {0.75, 0.5, 0.5}, true},   // inside
      {{0, 0.5, 0.5}, {1, 0.5, 0.5}, true},         // from wall to wall
      {{0, 0, 0}, {1, 0, 0}, true},                 // along an edge
      {{0.25, 0, 0.25}, {0.75, 0, 0.5}, true},      // in a face
      {{0.25, 0, 0.25}, {0.25, 0, next}, false},    // in a face's plane, beyond it
      {{0, 0, 0}, {next, 0, 0}, false},             // beyond the end of an edge
      {{0, 0, 0}, {0, 0, 0}, true},                 // a corner
      {{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, true},     // points
      {{next, 0.5, 0.5}, {next, 0.5, 0.5}, false},  //
      {{1, 0.5, 0.5}, {1, 0.5, 0.5}, true},
      {{-1, -1, -1}, {2, 2, 2}, false},  // through
      {{3, 3, 3}, {4, 3, 3}, false}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    ASSERT_EQ(test::segment_in_solid(c.p, c.q, box), c.in) << i;
    const Answer answer = c.in ? Answer::Verified : Answer::Refuted;
    std::vector<Mesh> meshes{repeated(c.p, c.q, static_cast<int>(i))};
    if (c.p != c.q) meshes.push_back(segment(c.p, c.q));
    for (const Mesh& thin : meshes) {
      const MeshVerdict alone = decided(thin, box);
      EXPECT_EQ(alone.inclusion.surface.answer, answer) << i;
      EXPECT_EQ(alone.inclusion.solid.answer, Answer::Undefined) << i;
      EXPECT_EQ(alone.answer, answer) << i;
      EXPECT_EQ(decided(thin, box, Claims::Solid).answer, Answer::Undefined) << i;
      const Mesh both = test::merged({box, thin});
      const MeshVerdict beside = decided(both, box);
      EXPECT_EQ(beside.answer, answer) << i;
      EXPECT_EQ(beside.inclusion.solid.answer != Answer::Refuted, true) << i;
      InclusionOptions surface_alone;
      surface_alone.surface_only = true;
      EXPECT_EQ(verify_inclusion(both, box, surface_alone).surface.answer, answer) << i;
      if (c.in) continue;
      EXPECT_EQ(beside.inclusion.surface.inner_triangles, std::vector<std::uint32_t>{12}) << i;
      ASSERT_TRUE(beside.inclusion.surface.witness) << i;
      ASSERT_TRUE(beside.surface_depth) << i;
      EXPECT_GE(beside.surface_depth->upper, beside.surface_depth->lower) << i;
    }
  }
  const MeshVerdict far = decided(segment(cases[0].p, cases[0].q), box);
  EXPECT_NEAR(far.surface_depth->lower, 4, 0.01);
  EXPECT_NEAR(far.surface_depth->upper, 4, 0.01);
  EXPECT_TRUE(far.inclusion.surface.witness->exact);
}

TEST(WithoutArea, MarginsAndDistancesCountThem) {
  const Mesh box = test::box({1, 1, 1}, 1);
  for (const Mesh& whisker :
       {segment({0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}), repeated({0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, 0)}) {
    const Mesh both = test::merged({box, whisker});
    geom::ConvexSet set{.bodies = {{"box", box}}, .provenance = {}};
    EXPECT_EQ(verify_cover(both, set).inclusion.surface.answer, Answer::Refuted);
    set_margin(set, 0.49);
    EXPECT_EQ(verify_cover(both, set).inclusion.surface.answer, Answer::Refuted);
    set_margin(set, 0.51);
    EXPECT_EQ(verify_cover(both, set).inclusion.surface.answer, Answer::Verified);
    EXPECT_EQ(verify_distance(both, box, 0.49).answer, Answer::Refuted);
    EXPECT_EQ(verify_distance(both, box, 0.51).answer, Answer::Verified);
    // What is near the whisker alone is not said to be far away.
    const Mesh there = test::translated(test::box({0.01, 0.01, 0.01}, 1), {1.4, 0.5, 0.5});
    EXPECT_EQ(verify_distance(there, both, 0.1).answer, Answer::Undecided);
    EXPECT_EQ(verify_distance(test::translated(there, {0, 5, 0}), both, 0.1).answer,
              Answer::Refuted);
  }
}

/// Random segments and points on a lattice, some of them edges and corners of the mesh.
Mesh thin_triangles(test::Random& random, const Mesh& near) {
  Mesh out;
  const auto lattice = [&] {
    const auto number = [&] { return static_cast<double>(random() % 13) / 2 - 1; };
    const double x = number(), y = number(), z = number();
    return Vec3(x, y, z);
  };
  const auto pick = [&]() -> Vec3 {
    if (near.triangles.empty() || random() % 3 == 0) return lattice();
    const auto& t = near.triangles[random() % near.triangles.size()];
    const Vec3 &a = near.vertices[t[0]], &b = near.vertices[t[random() % 3]];
    return random() % 2 == 0 ? a : Vec3(0.5 * (a + b));
  };
  const Vec3 p = pick(), q = random() % 4 == 0 ? p : pick();
  // Halfway between two points of a bent pair may be off their line.
  const Mesh three = segment(p, q);
  const bool straight =
      geom::is_degenerate(three.vertices[0], three.vertices[1], three.vertices[2]);
  return straight && p != q && random() % 2 == 0 ? three
                                                 : repeated(p, q, static_cast<int>(random() % 3));
}

TEST(WithoutArea, AsTheRationalOracleSays) {
  int in = 0, out = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const test::MeshPair pair = seed % 3 == 0 ? test::bent_pair(seed) : test::lattice_pair(seed);
    test::Random random(seed);
    for (int i = 0; i < 3; ++i) {
      const Mesh thin = thin_triangles(random, pair.outer);
      const bool truth = test::thin_in_solid(thin, pair.outer);
      ++(truth ? in : out);
      const Inclusion found = verify_inclusion(thin, pair.outer);
      if (pair.outer.triangles.empty()) continue;
      EXPECT_EQ(found.surface.answer, truth ? Answer::Verified : Answer::Refuted)
          << pair.name << " " << i;
    }
  }
  EXPECT_GE(in, 100);
  EXPECT_GE(out, 100);
}

TEST(WithoutArea, BesideOthersAsBothOraclesSay) {
  test::Tally tally;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    test::MeshPair pair = test::lattice_pair(seed);
    test::Random random(seed);
    pair.inner = test::merged({pair.inner, thin_triangles(random, pair.inner)});
    pair.outer = test::merged({pair.outer, thin_triangles(random, pair.outer)});
    tally.judge_one(pair, seed);
  }
  EXPECT_EQ(tally.faults(), "");
}

}  // namespace
}  // namespace kaboum::verify
