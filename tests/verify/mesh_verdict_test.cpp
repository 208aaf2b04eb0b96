// All claims about two meshes together: which of them decide, and what is measured beside them.
#include <kaboum/verify/mesh_verdict.h>

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/verify/subject.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "inside_out.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test
using verify::Answer;
using verify::Between;
using verify::Claims;
using verify::MeshQuestion;
using verify::MeshVerdict;
using verify::Relation;

Mesh cube(double low, double high) {
  return translated(box(Vec3::Constant(high - low), 1), Vec3::Constant(low));
}

MeshVerdict decided(const Mesh& original, const Mesh& approximation, Relation relation,
                    Claims claims = Claims::All, std::optional<double> bound = {}) {
  return verify::decide({original, approximation, nullptr, relation, claims, bound});
}

TEST(MeshVerdict, RelationSaysWhichEncloses) {
  const Mesh small = cube(0, 1), large = cube(-1, 2);
  EXPECT_EQ(decided(small, large, Relation::Outer).answer, Answer::Verified);
  EXPECT_EQ(decided(large, small, Relation::Inner).answer, Answer::Verified);
  EXPECT_EQ(decided(large, small, Relation::Outer).answer, Answer::Refuted);
  EXPECT_EQ(decided(small, large, Relation::Inner).answer, Answer::Refuted);
}

TEST(MeshVerdict, DepthsAreMeasuredWhereRefuted) {
  const Mesh small = cube(0, 1), large = cube(-1, 2);
  const MeshVerdict refuted = decided(large, small, Relation::Outer);
  ASSERT_TRUE(refuted.solid_depth && refuted.surface_depth);
  EXPECT_LE(refuted.surface_depth->lower, std::sqrt(3.0));
  EXPECT_GE(refuted.surface_depth->upper, std::sqrt(3.0));
  EXPECT_GT(refuted.surface_depth->lower, 1.7);
  const MeshVerdict verified = decided(small, large, Relation::Outer);
  EXPECT_FALSE(verified.solid_depth || verified.surface_depth);
}

// Triangles that close a hole may reach out: they bound the solid, but are none of the file's.
TEST(MeshVerdict, TrianglesThatCloseHolesNeedNotLieInside) {
  verify::Subject subject;
  subject.mesh = cube(0, 1);
  const auto first = static_cast<std::uint32_t>(subject.mesh.vertices.size());
  for (const Vec3& corner : {Vec3{0.5, 0.5, 0.5}, Vec3{0.6, 0.5, 0.5}, Vec3{0.5, 0.5, 5}})
    subject.mesh.vertices.push_back(corner);
  subject.mesh.triangles.push_back({first, first + 1, first + 2});
  subject.mesh.triangles.push_back({first, first + 2, first + 1});
  const auto decided_of = [&](const Mesh& result) {
    return verify::decide({.original = subject.mesh,
                           .approximation = result,
                           .set = nullptr,
                           .relation = Relation::Outer,
                           .subject = &subject});
  };
  EXPECT_EQ(decided_of(cube(-1, 2)).answer, Answer::Refuted);
  subject.filled_triangles = 2;
  EXPECT_EQ(decided_of(cube(-1, 2)).answer, Answer::Verified);
  EXPECT_EQ(decided_of(cube(0.25, 2)).answer, Answer::Refuted);
}

Mesh joined(Mesh a, const Mesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles)
    a.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return a;
}

Mesh triangle(const Vec3& a, const Vec3& b, const Vec3& c) { return {{a, b, c}, {{0, 1, 2}}}; }

Answer answer_about(const verify::Subject& subject, const Mesh& result,
                    Claims claims = Claims::All) {
  MeshQuestion q{subject.mesh, result, nullptr, Relation::Outer, claims, {}};
  q.subject = &subject;
  return verify::decide(q).answer;
}

verify::Subject refused(const Mesh& mesh) {
  verify::Subject out = verify::unprepared_subject(mesh);
  out.refusal = "a test";
  return out;
}

// Nothing is said of triangles that bound no solid but that they lie inside.
TEST(MeshVerdict, RefusedTrianglesAreVerifiedByTheirSurfaceAlone) {
  const Mesh open = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(answer_about(refused(open), cube(-1, 2)), Answer::Verified);
  EXPECT_EQ(answer_about(refused(open), open), Answer::Undefined);  // the same border
  EXPECT_EQ(answer_about(refused(open), cube(-1, 2), Claims::Solid), Answer::Undefined);
  const Mesh sheet = joined(open, verify::turned(open));
  EXPECT_EQ(answer_about(refused(sheet), cube(8, 9), Claims::Solid), Answer::Undefined);
}

// A part that is closed by itself is held with what it winds round, whatever lies beside it.
TEST(MeshVerdict, ClosedPartsOfRefusedTrianglesAreHeld) {
  const Mesh open = triangle({0, 0, 1.5}, {1, 0, 1.5}, {0, 1, 1.5});
  const Mesh hollow = joined(cube(-1, 2), verify::turned(cube(0.3, 0.7)));
  for (const Mesh& part : {cube(0, 1), verify::turned(cube(0, 1))}) {
    EXPECT_EQ(answer_about(refused(joined(part, open)), hollow), Answer::Refuted);
    EXPECT_EQ(answer_about(refused(joined(part, open)), cube(-1, 2)), Answer::Verified);
  }
  // Parts the windings of which cancel.
  const Mesh cancelled = joined(cube(0, 1), verify::turned(cube(0.2, 0.8)));
  EXPECT_EQ(answer_about(refused(joined(cancelled, open)), hollow), Answer::Refuted);
}

// What preparing had to guess is not verified unless all that it may be is held.
TEST(MeshVerdict, HollowsOfSurfacesThatCrossThemselvesAreLeftOpen) {
  verify::Subject guessed;
  guessed.mesh = joined(cube(0, 1), verify::turned(cube(0.2, 0.8)));
  guessed.both_ways = guessed.is_prepared = true;
  const Mesh hollow = joined(cube(-1, 2), verify::turned(cube(0.3, 0.7)));
  EXPECT_EQ(answer_about(guessed, hollow), Answer::Undecided);
  EXPECT_EQ(answer_about(guessed, cube(-1, 2)), Answer::Verified);
}

// Of flat parts whose holes were filled the volume is 0, up to a rounding that may be negative:
// that says nothing of which way they are meant.
TEST(MeshVerdict, FlatPartsWithFilledHolesAreDecided) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> anywhere(0, 1);
  int negative = 0;
  for (int k = 0; k < 64; ++k) {
    Mesh rings;
    constexpr std::uint32_t kCorners = 9;
    for (int part = 0; part < 8; ++part) {
      const auto first = static_cast<std::uint32_t>(rings.vertices.size());
      const Vec3 at(part + anywhere(random), anywhere(random), anywhere(random));
      const double turn = anywhere(random);
      for (const double radius : {0.1, 0.2})
        for (std::uint32_t i = 0; i < kCorners; ++i) {
          const double angle = turn + 2 * std::numbers::pi * i / kCorners;
          rings.vertices.push_back(at +
                                   Vec3(radius * std::cos(angle), radius * std::sin(angle), 0));
        }
      for (std::uint32_t i = 0; i < kCorners; ++i) {
        const std::uint32_t next = (i + 1) % kCorners;
        rings.triangles.push_back({first + i, first + kCorners + i, first + kCorners + next});
        rings.triangles.push_back({first + i, first + kCorners + next, first + next});
      }
    }
    const verify::Subject subject = verify::prepared_subject(rings, {.holes = geom::Holes::Fill});
    if (!(geom::signed_volume(subject.mesh) < 0)) continue;
    ++negative;
    EXPECT_TRUE(subject.both_ways);
    EXPECT_EQ(answer_about(subject, cube(-1, 12)), Answer::Verified);
    EXPECT_EQ(answer_about(subject, cube(1, 12)), Answer::Refuted);
  }
  EXPECT_GT(negative, 0);
}

// Sheets dropped on request are not asked for; what else preparing leaves out is.
TEST(MeshVerdict, LeftOutTrianglesAreHeldBesideDroppedSheets) {
  const Mesh flap = triangle({5, 5, 5}, {6, 5, 5}, {5, 6, 5});
  Mesh file = joined(joined(cube(0, 1), flap), verify::turned(flap));
  const geom::PrepareOptions options{.drop_sheets = true, .holes = geom::Holes::Fill};
  EXPECT_EQ(answer_about(verify::prepared_subject(file, options), cube(-1, 2)), Answer::Verified);
  const auto first = static_cast<std::uint32_t>(file.vertices.size());
  file.vertices.push_back({0.5, 0.5, 0.5});
  file.vertices.push_back({0.5, 0.5, 4});
  file.triangles.push_back({first, first + 1, first + 1});
  const verify::Subject subject = verify::prepared_subject(file, options);
  EXPECT_EQ(subject.report.dropped_sheets, 2U);
  EXPECT_EQ(answer_about(subject, cube(-1, 2)), Answer::Refuted);
  EXPECT_EQ(verify::source_of_held(
                subject, static_cast<std::uint32_t>(subject.triangles.triangles.size() - 1)),
            file.triangles.size() - 1);
}

// Where preparing refuses the triangles, all of them are to be held, and all that they wind round.
TEST(MeshVerdict, SubjectsThatCannotBePrepared) {
  Mesh file = verify::turned(cube(0, 1));
  for (const Vec3& v : {Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(2, 1, 0)}) file.vertices.push_back(v);
  const auto first = static_cast<std::uint32_t>(file.vertices.size() - 3);
  file.triangles.push_back({first, first + 1, first + 2});
  file.triangles.push_back({first, first + 2, first + 1});
  const verify::Subject subject = verify::prepared_subject(file, {.holes = geom::Holes::Fill});
  EXPECT_NE(subject.refusal.find("sheets"), std::string::npos) << subject.refusal;
  const auto decided_of = [&](const Mesh& approximation) {
    MeshQuestion question{subject.mesh, approximation};
    question.subject = &subject;
    return verify::decide(question);
  };
  EXPECT_EQ(decided_of(cube(-1, 4)).answer, Answer::Verified);
  const MeshVerdict box_only = decided_of(cube(-0.5, 1.5));
  EXPECT_EQ(box_only.answer, Answer::Refuted);
  EXPECT_EQ(box_only.inclusion.surface.inner_triangles.size(), 2U);
  Mesh hollow = cube(-1, 4);
  const Mesh cavity = verify::turned(cube(0.25, 0.75));
  for (const auto& t : cavity.triangles) {
    const auto n = static_cast<std::uint32_t>(cube(-1, 4).vertices.size());
    hollow.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  hollow.vertices.insert(hollow.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  const MeshVerdict holed = decided_of(hollow);
  EXPECT_EQ(holed.inclusion.surface.answer, Answer::Verified);
  EXPECT_EQ(holed.inclusion.solid.answer, Answer::Refuted);
  ASSERT_TRUE(holed.solid_depth);
  EXPECT_GT(holed.solid_depth->lower, 0.2);
  EXPECT_THROW(
      (void)verify::prepared_subject(Mesh{}, {.drop_sheets = true, .holes = geom::Holes::Fill}),
      Error);
}

// What preparing leaves out is judged as well, and named.
TEST(MeshVerdict, TrianglesBesideThePreparedOnes) {
  const Mesh original = cube(0, 1), approximation = cube(-1, 2);
  verify::Subject subject;
  subject.has_more = true;
  subject.triangles = original;
  MeshQuestion question{original, approximation};
  question.subject = &subject;
  EXPECT_EQ(verify::decide(question).answer, Answer::Verified);
  const auto first = static_cast<std::uint32_t>(subject.triangles.vertices.size());
  for (const Vec3& v : {Vec3(0, 0, 0), Vec3(5, 0, 0), Vec3(0, 1, 0)})
    subject.triangles.vertices.push_back(v);
  subject.triangles.triangles.push_back({first, first + 1, first + 2});
  const MeshVerdict verdict = verify::decide(question);
  EXPECT_EQ(verdict.answer, Answer::Refuted);
  EXPECT_EQ(verdict.inclusion.solid.answer, Answer::Verified);
  ASSERT_TRUE(verdict.surface_of_all && verdict.surface_depth);
  EXPECT_NEAR(verdict.surface_depth->upper, 3, 0.01);
  EXPECT_EQ(verify::offending_triangles(question, verdict).triangles.size(), 1U);
}

// Of a quad that is not plane both ways to split it are to be held.
TEST(MeshVerdict, OtherWaysToSplitQuads) {
  Mesh file;
  file.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
  file.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}};
  geom::PrepareOptions options{.holes = geom::Holes::Fill};
  options.quads = {0};
  options.diagonal = geom::PrepareOptions::Diagonal::Outward;
  const verify::Subject subject = verify::prepared_subject(file, options);
  ASSERT_FALSE(subject.refusal.empty());
  ASSERT_TRUE(subject.has_more);
  const std::vector<geom::Triangle>& all = subject.triangles.triangles;
  ASSERT_EQ(all.size(), 6U);
  EXPECT_EQ(all[4], (geom::Triangle{1, 2, 3}));
  EXPECT_EQ(all[5], (geom::Triangle{1, 3, 0}));
}

// The margin of a cover is taken off what sticks out, and the claim knows of it.
TEST(MeshVerdict, MarginOfACover) {
  const Mesh original = cube(0, 2);
  geom::ConvexSet set;
  set.bodies.push_back({"body", cube(0.5, 1.5)});
  for (const double margin : {0.25, 1.0}) {
    set_margin(set, margin);
    const Mesh sum = verify::sum_of(set);
    const MeshVerdict verdict =
        verify::decide({original, sum, &set, Relation::Cover, Claims::All, 1.5});
    ASSERT_TRUE(verdict.convex);
    EXPECT_EQ(verdict.convex->answer, Answer::Verified);
    ASSERT_EQ(verdict.distances.size(), 1U);
    EXPECT_EQ(verdict.distances[0].between, Between::UnionToSolid);
    EXPECT_EQ(verdict.answer, margin < 0.8 ? Answer::Refuted : Answer::Verified);
    if (margin > 0.8) continue;
    const double corner = 0.5 * std::sqrt(3.0) - margin;
    EXPECT_LE(verdict.surface_depth->lower, corner);
    EXPECT_GE(verdict.surface_depth->upper, corner);
  }
}

TEST(MeshVerdict, ClaimsThatDecide) {
  const auto made = [](Answer solid, Answer surface) {
    MeshVerdict v;
    v.inclusion.solid.answer = solid;
    v.inclusion.surface.answer = surface;
    return v;
  };
  using enum Answer;
  EXPECT_EQ(answer_of(made(Verified, Refuted), Claims::All), Refuted);
  EXPECT_EQ(answer_of(made(Verified, Refuted), Claims::Solid), Verified);
  EXPECT_EQ(answer_of(made(Undefined, Verified), Claims::All), Verified);
  EXPECT_EQ(answer_of(made(Undefined, Verified), Claims::Solid), Undefined);
  EXPECT_EQ(answer_of(made(Undecided, Verified), Claims::All), Undecided);
  // Everything else can only worsen it.
  MeshVerdict besides = made(Verified, Verified);
  besides.convex.emplace().answer = Refuted;
  EXPECT_EQ(answer_of(besides, Claims::All), Refuted);
  besides.convex->answer = Verified;
  besides.distances.emplace_back().claim.answer = Undefined;
  EXPECT_EQ(answer_of(besides, Claims::All), Undefined);
  besides.distances[0].claim.answer = Undecided;
  EXPECT_EQ(answer_of(besides, Claims::All), Undecided);
  besides.distances.clear();
  besides.depth.emplace().answer = Refuted;
  EXPECT_EQ(answer_of(besides, Claims::Solid), Refuted);
}

// That an empty solid is within another says nothing.
TEST(MeshVerdict, EmptySolidIsNoVerdict) {
  const Mesh turned = flipped(cube(0, 1)), large = cube(-1, 2);
  const MeshVerdict alone = decided(turned, large, Relation::Outer, Claims::Solid);
  EXPECT_TRUE(alone.vacuous);
  EXPECT_EQ(alone.inclusion.solid.answer, Answer::Verified);
  EXPECT_EQ(alone.answer, Answer::Undefined);
  EXPECT_EQ(decided(turned, large, Relation::Outer).answer, Answer::Verified);
}

// Nor may rounding make a solid that is not empty look so: of what is nearly flat the rounded
// volume has any sign.
TEST(MeshVerdict, RoundingTurnsNoSolidInsideOut) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  const auto orientation = [](const Mesh& m) {
    return geom::detail::orient3d_exact(m.vertices[0], m.vertices[1], m.vertices[2], m.vertices[3]);
  };
  const Mesh unit_tetrahedron{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                              {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  ASSERT_GT(geom::signed_volume(unit_tetrahedron), 0);
  const Mesh large = cube(-9, 9);
  int misleading = 0;
  for (int round = 0; round < 20000 && misleading < 20; ++round) {
    const Vec3 a = point(), b = point(), c = point();
    const double u = unit(random), v = unit(random);
    Mesh flat = unit_tetrahedron;
    flat.vertices = {a, b, c, a + u * (b - a) + v * (c - a)};
    const geom::Sign sign = orientation(flat);
    if (sign == geom::Sign::Zero) continue;
    const Mesh outward = sign == orientation(unit_tetrahedron) ? flat : flipped(flat);
    if (!(geom::signed_volume(outward) < 0)) continue;
    ++misleading;
    EXPECT_FALSE(decided(outward, large, Relation::Outer, Claims::Solid).vacuous);
    EXPECT_TRUE(decided(flipped(outward), large, Relation::Outer, Claims::Solid).vacuous);
  }
  EXPECT_EQ(misleading, 20);
}

// A needle far away, whose normals' components underflow: its faces are crossed or not whatever
// corner each begins with, and a solid at the origin is not inside.
TEST(MeshVerdict, ANeedleFarAwayEnclosesNothing) {
  Mesh small;
  small.vertices = {{1e-172, 0, 0},
                    {-1e-172, 1e-172, 1e-173},
                    {-9e-173, -1e-172, 7e-173},
                    {-8e-173, -6e-173, -1e-172}};
  small.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  Mesh needle;
  needle.vertices = {{1.0000000001e300, -3e-170, 0},
                     {1e300, 3e-170, -4e-170},
                     {1e300, 3e-170, 4e-170},
                     {1.0000000003e300, -1e-170, 0}};
  needle.triangles = {{0, 2, 1}, {1, 3, 0}, {1, 2, 3}, {2, 0, 3}};
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_NE(verify::verify_inclusion(small, needle).solid.answer, verify::Answer::Verified)
        << turn;
    for (geom::Triangle& t : needle.triangles) std::ranges::rotate(t, t.begin() + 1);
  }
}

// Two tiny corners over and under a large ring, so that every product of three has one of them: by
// powers of two, the volume is that of a mesh of middle size, whose products round alike.
TEST(MeshVerdict, TinyAndLargeCornersTurnNoSolidInsideOut) {
  constexpr std::uint32_t kRing = 5;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  int turned = 0;
  for (int round = 0; round < 400; ++round) {
    Mesh mesh;
    Vec3 normal = Vec3::Zero();
    for (std::uint32_t i = 0; i < kRing; ++i) mesh.vertices.push_back(point());
    for (std::uint32_t i = 0; i < kRing; ++i) {
      const std::uint32_t j = (i + 1) % kRing;
      normal += mesh.vertices[i].cross(mesh.vertices[j]);
      mesh.triangles.push_back({kRing, i, j});
      mesh.triangles.push_back({kRing + 1, j, i});
    }
    // Nearly no volume: what rounding leaves of it.
    const Vec3 top = point(), across = point();
    mesh.vertices.push_back(top);
    mesh.vertices.push_back(top + across - normal * (across.dot(normal) / normal.squaredNorm()));
    Mesh scaled = mesh;
    for (std::uint32_t i = 0; i < kRing + 2; ++i)
      scaled.vertices[i] *= i < kRing ? 0x1p+330 : 0x1p-565;  // 2e99, 8e-171
    const bool is_turned = verify::is_inside_out(mesh);
    EXPECT_EQ(verify::is_inside_out(scaled), is_turned) << round;
    turned += is_turned ? 1 : 0;
  }
  EXPECT_GT(turned, 100);
  EXPECT_LT(turned, 300);
  for (const double size : {1e-170, 1e-100, 1e-60, 1e60, 1e100}) {
    const Mesh body = cube(size, 2 * size);
    EXPECT_FALSE(verify::is_inside_out(body)) << size;
    EXPECT_TRUE(verify::is_inside_out(flipped(body))) << size;
  }
}

TEST(MeshVerdict, DistancesBothWaysAndTheirWitness) {
  const Mesh small = cube(0, 1), large = cube(-1, 2);
  std::size_t calls = 0;
  const MeshQuestion question{small, large, nullptr, Relation::Outer, Claims::All, 1.5};
  const MeshVerdict verdict = verify::decide(question, [&](const MeshVerdict& so_far) {
    ++calls;
    EXPECT_EQ(so_far.inclusion.solid.answer, Answer::Verified);
    EXPECT_TRUE(so_far.distances.empty());
  });
  EXPECT_EQ(calls, 1U);
  ASSERT_EQ(verdict.distances.size(), 2U);
  EXPECT_EQ(verdict.distances[0].between, Between::ApproximationToOriginal);
  EXPECT_EQ(verdict.distances[0].claim.answer, Answer::Refuted);
  EXPECT_EQ(verdict.distances[1].claim.answer, Answer::Verified);
  EXPECT_EQ(verdict.answer, Answer::Refuted);
  const Mesh witness = verify::offending_triangles(question, verdict);
  ASSERT_EQ(witness.triangles.size(), 1U);
  EXPECT_GT(witness.vertices[0].cwiseAbs().maxCoeff(), 0.99);  // of the larger cube
  EXPECT_TRUE(
      verify::offending_triangles(question, decided(small, large, Relation::Outer)).empty());
}

TEST(MeshVerdict, InnerSetLeavesOut) {
  const Mesh original = cube(0, 1);
  geom::ConvexSet set;
  set.bodies.push_back({"body", cube(0.25, 0.75)});
  const Mesh sum = verify::sum_of(set);
  for (const double bound : {0.24, 0.26}) {
    const MeshVerdict verdict =
        verify::decide({original, sum, &set, Relation::Inner, Claims::All, bound});
    ASSERT_TRUE(verdict.depth);
    EXPECT_EQ(verdict.depth->answer, bound < 0.25 ? Answer::Refuted : Answer::Verified);
    EXPECT_EQ(verdict.answer, verdict.depth->answer);
  }
}

}  // namespace
