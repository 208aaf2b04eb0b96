// Bounding meshes are verified; spoilt ones are refuted exactly when they are wrong.
#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/verify/inclusion.h>

#include <gtest/gtest.h>

#include "judge.h"
#include "pairs.h"
#include "support/families.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test
using bmesh::Direction;

MeshPair bounding_pair(const std::string& name, const Mesh& mesh, Direction direction, double ratio,
                       bmesh::Precision precision) {
  const geom::Prepared prepared = geom::prepare(mesh);
  bmesh::DecimateOptions options;
  options.direction = direction;
  options.precision = precision;
  options.vertices = static_cast<std::size_t>(
      std::max(4.0, ratio * static_cast<double>(prepared.solid.mesh().vertices.size())));
  Mesh result = bmesh::decimate(prepared.solid, options).mesh;
  return direction == Direction::Outer ? MeshPair{name + " outer", prepared.solid.mesh(), result}
                                       : MeshPair{name + " inner", result, prepared.solid.mesh()};
}

TEST(Mutants, WrongOnesAreRefutedAndRightOnesVerified) {
  const Mesh ball = icosphere(1);
  const std::vector<std::pair<std::string, Mesh>> shapes{
      {"ball", ball},
      {"box", box({1, 2, 0.5}, 3)},
      {"odd box", translated(box({0.123, 0.234, 0.345}, 3), {0.1, 0.2, 0.3})},
      {"rotated box", rotated(box({0.123, 0.234, 0.345}, 3), 0.7)},
      {"torus", torus(1, 0.4, 10, 6)},
      {"noisy", noisy(icosphere(1), 0.2, 3)},
      {"two balls", merged({ball, translated(ball, {1, 0.1, 0.2})})},
      {"cavity", merged({ball, flipped(scaled(ball, Vec3::Constant(0.5)))})},
      {"far", translated(icosphere(1), {1234.5678, -9876.54321, 4321.0987})},
      {"plate", rotated(box({1, 1, 1e-3}, 3), 0.3)}};
  Tally tally;
  std::uint64_t seed = 1;
  for (const auto& [name, mesh] : shapes) {
    for (const Direction d : {Direction::Outer, Direction::Inner}) {
      const MeshPair pair = bounding_pair(name, mesh, d, 0.6, bmesh::Precision::Double);
      const auto claim = verify::verify_inclusion(pair.inner, pair.outer);
      EXPECT_EQ(claim.solid.answer, verify::Answer::Verified) << pair.name;
      for (const MeshPair& mutant : mutants(pair, ++seed, 2)) tally.judge_one(mutant, seed);
    }
  }
  EXPECT_EQ(tally.faults(), "");
  EXPECT_GE(tally.solid_false(), 20U);
  EXPECT_GE(tally.solid_true(), 1U);
  RecordProperty("refuted", static_cast<int>(tally.solid_false()));
}

TEST(BoundingMeshes, OfAllFamiliesAreVerified) {
  for (const auto& list : {closed_families(), open_families()}) {
    for (const auto& family : list) {
      if (family.mesh.triangles.size() > 3000) continue;
      for (const Direction d : {Direction::Outer, Direction::Inner}) {
        MeshPair pair;
        try {
          pair = bounding_pair(family.name, family.mesh, d, 0.2, bmesh::Precision::Float);
        } catch (const Error&) {
          continue;  // nothing but sheets
        }
        const auto claim = verify::verify_inclusion(pair.inner, pair.outer);
        EXPECT_EQ(claim.solid.answer, verify::Answer::Verified)
            << pair.name << ": " << claim.solid.reason;
        EXPECT_EQ(claim.relative, !claim.inner_closed) << pair.name;
      }
    }
  }
}

// Numbers for which nothing needs to be computed.
TEST(Inclusion, NearTheEndsOfTheRangeOfDouble) {
  for (const double scale : {1e-320, 1e-300, 1e-160, 1e-100, 1e60, 1e100, 1e150, 1e300}) {
    const Mesh unit = box({1, 1, 1}, 2);
    const Mesh inner = scaled(unit, Vec3::Constant(scale));
    Mesh outer = scaled(translated(box({3, 3, 3}, 1), {-1, -1, -1}), Vec3::Constant(scale));
    const auto yes = verify::verify_inclusion(inner, outer);
    EXPECT_EQ(yes.solid.answer, verify::Answer::Verified) << scale;
    EXPECT_EQ(yes.surface.answer, verify::Answer::Verified) << scale;
    const auto no = verify::verify_inclusion(outer, inner);
    EXPECT_EQ(no.solid.answer, verify::Answer::Refuted) << scale;
    EXPECT_EQ(no.surface.answer, verify::Answer::Refuted) << scale;
    const auto same =
        verify::verify_inclusion(inner, scaled(box({1, 1, 1}, 1), Vec3::Constant(scale)));
    EXPECT_EQ(same.solid.answer, verify::Answer::Verified) << scale;
    EXPECT_EQ(same.surface.answer, verify::Answer::Verified) << scale;
  }
}

TEST(Inclusion, CoordinatesOfVeryDifferentSize) {
  // A needle from 1e-200 to 1e200 in a box, and one that leaves it by the smallest number there is.
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const double big : {1.0, 1e30, 1e200}) {
    const Mesh needle{{{0, 0, 0}, {big, 1e-200, 0}, {big, 0, 1e-200}, {big, -1e-200, -1e-200}},
                      {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
    const Mesh round = translated(box({big, 2, 2}, 1), {0, -1, -1});
    EXPECT_EQ(verify::verify_inclusion(needle, round).solid.answer, verify::Answer::Verified)
        << big;
    Mesh out = needle;
    out.vertices[0].x() = -tiny;
    EXPECT_EQ(verify::verify_inclusion(out, round).solid.answer, verify::Answer::Refuted) << big;
  }
}

TEST(Inclusion, RefusesWhatIsNoMesh) {
  Mesh bad = box({1, 1, 1}, 1);
  bad.triangles[0][0] = 99;
  EXPECT_THROW(verify::verify_inclusion(bad, box({1, 1, 1}, 1)), Error);
  EXPECT_THROW(verify::verify_inclusion(box({1, 1, 1}, 1), bad), Error);
  bad = box({1, 1, 1}, 1);
  bad.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(verify::verify_inclusion(bad, box({1, 1, 1}, 1)), Error);
}

}  // namespace
