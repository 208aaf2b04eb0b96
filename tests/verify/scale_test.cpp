// Answers do not depend on the unit of length, however small or large, nor on whether coplanar
// cells are settled or sampled.
#include <kaboum/verify/inclusion.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pairs.h"

namespace {

using namespace kaboum;
using geom::Mesh;
using geom::Vec3;

void add_tetrahedron(Mesh& mesh, Vec3 a, Vec3 b, const Vec3& c, const Vec3& d) {
  if ((b - a).cross(c - a).dot(d - a) < 0) std::swap(a, b);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
  for (const auto& [i, j, k] : {std::array{0U, 2U, 1U}, {0U, 1U, 3U}, {1U, 2U, 3U}, {2U, 0U, 3U}})
    mesh.triangles.push_back({first + i, first + j, first + k});
}

/// A corner that four large tetrahedra cover but for a gap, bounded by parts of long cuts.
test::MeshPair gap(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&](int low, int high) {
    return static_cast<double>(std::uniform_int_distribution<int>(low, high)(random));
  };
  test::MeshPair pair;
  add_tetrahedron(pair.inner, {-2, -2, -2}, {9, -2, -2}, {-2, 9, -2}, {-2, -2, 9});
  for (int k = 0; k < 3; ++k) {
    const auto in_plane = [&](double height, double u, double v) {
      Vec3 p;
      p[k] = height;
      p[(k + 1) % 3] = u;
      p[(k + 2) % 3] = v;
      return p;
    };
    const Vec3 a = in_plane(0, number(-90, -20), number(-90, -20));
    const Vec3 b = in_plane(0, number(50, 150), number(-60, -10));
    const Vec3 c = in_plane(0, number(-60, -10), number(50, 150));
    add_tetrahedron(pair.outer, a, b, c, in_plane(-number(100, 200), number(-5, 5), number(-5, 5)));
  }
  const auto on_slope = [](double x, double y) { return Vec3(x, y, 1 - x - y); };
  const Vec3 a = on_slope(number(-90, -20), number(-90, -20));
  const Vec3 b = on_slope(number(50, 150), number(-60, -10));
  const Vec3 c = on_slope(number(-60, -10), number(50, 150));
  add_tetrahedron(pair.outer, a, b, c, {200, 200, 200});
  return pair;
}

test::MeshPair scaled(test::MeshPair pair, int exponent) {
  for (Mesh* mesh : {&pair.inner, &pair.outer})
    for (Vec3& p : mesh->vertices) p *= std::ldexp(1.0, exponent);
  return pair;
}

TEST(Scale, ChangesNoAnswerAndNoSample) {
  int refuted = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    const test::MeshPair pair = gap(seed);
    const verify::Inclusion at_one = verify::verify_inclusion(pair.inner, pair.outer);
    refuted += static_cast<int>(at_one.solid.answer == verify::Answer::Refuted);
    for (const int exponent : {-1000, -537, -230, -215, 203, 206, 900}) {
      const test::MeshPair other = scaled(pair, exponent);
      const verify::Inclusion result = verify::verify_inclusion(other.inner, other.outer);
      EXPECT_EQ(result.solid.answer, at_one.solid.answer) << seed << " 2^" << exponent;
      EXPECT_EQ(result.surface.answer, at_one.surface.answer) << seed << " 2^" << exponent;
      EXPECT_EQ(result.samples, at_one.samples) << seed << " 2^" << exponent;
    }
  }
  EXPECT_GE(refuted, 5);
}

TEST(Scale, MayDifferBetweenParts) {
  // One more part, which both meshes have, so large that no common scale suits both.
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    const test::MeshPair pair = gap(seed);
    const verify::Answer expected = verify::verify_inclusion(pair.inner, pair.outer).solid.answer;
    test::MeshPair spread = scaled(pair, -230);
    const double far = std::ldexp(1.0, 900);
    for (Mesh* mesh : {&spread.inner, &spread.outer})
      add_tetrahedron(*mesh, {far, far, far}, {2 * far, far, far}, {far, 2 * far, far},
                      {far, far, 2 * far});
    EXPECT_EQ(verify::verify_inclusion(spread.inner, spread.outer).solid.answer, expected) << seed;
  }
}

TEST(Settling, ChangesNoAnswer) {
  verify::InclusionOptions always, never;
  always.settle_from = 0;
  never.settle_from = std::numeric_limits<std::size_t>::max();
  for (std::uint64_t seed = 5000; seed < 5400; ++seed) {
    const test::MeshPair pair = test::lattice_pair(seed);
    const verify::Inclusion a = verify::verify_inclusion(pair.inner, pair.outer, always);
    const verify::Inclusion b = verify::verify_inclusion(pair.inner, pair.outer, never);
    EXPECT_EQ(a.solid.answer, b.solid.answer) << seed;
    EXPECT_EQ(a.surface.answer, b.surface.answer) << seed;
    EXPECT_EQ(a.solid.inner_triangles, b.solid.inner_triangles) << seed;
    EXPECT_EQ(a.solid.outer_triangles, b.solid.outer_triangles) << seed;
  }
}

}  // namespace
