// Spheres through four points against rationals; meshes that meet themselves, and those that do
// not.
#include <gtest/gtest.h>
#include <kaboum/geom/in_sphere.h>
#include <kaboum/geom/self_intersection.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <random>

#include "support/shapes.h"

namespace kaboum::geom {
namespace {

using Rational = boost::multiprecision::cpp_rational;

Sign in_sphere_slow(const std::array<Vec3, 4>& corners, const Vec3& e) {
  Rational m[4][4];
  for (int i = 0; i < 4; ++i) {
    m[i][3] = 0;
    for (int k = 0; k < 3; ++k) {
      m[i][k] = Rational(corners[i][k]) - Rational(e[k]);
      m[i][3] += m[i][k] * m[i][k];
    }
  }
  Rational det = 1;
  for (int i = 0; i < 4; ++i) {
    int pivot = i;
    while (pivot < 4 && m[pivot][i] == 0) ++pivot;
    if (pivot == 4) return Sign::Zero;
    if (pivot != i) {
      std::swap(m[pivot], m[i]);
      det = -det;
    }
    det *= m[i][i];
    for (int r = i + 1; r < 4; ++r) {
      const Rational f = m[r][i] / m[i][i];
      for (int k = i; k < 4; ++k) m[r][k] -= f * m[i][k];
    }
  }
  return static_cast<Sign>(-det.sign());
}

TEST(InSphere, IsPositiveInside) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(in_sphere(o, x, y, z, Vec3(0.5, 0.5, 0.5)), Sign::Positive);
  EXPECT_EQ(in_sphere(o, x, y, z, Vec3(1, 1, 1.01)), Sign::Negative);
  EXPECT_EQ(in_sphere(o, x, y, z, Vec3(1, 1, 1)), Sign::Zero);
  EXPECT_EQ(in_sphere(o, y, x, z, Vec3(0.5, 0.5, 0.5)), Sign::Negative);
}

TEST(InSphere, AgreesWithRationalsNearSpheres) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> whole(-4, 4), nudge(-1, 1), exponent(-250, 250);
  int zeros = 0;
  for (int i = 0; i < 2000; ++i) {
    const double scale = i % 4 == 0 ? std::ldexp(1.0, exponent(random)) : 1;
    const Vec3 offset = i % 2 == 0 ? Vec3(1e4, -3e4, 77) : Vec3(0, 0, 0);
    // Points of a lattice are often on one sphere.
    const auto point = [&] {
      return Vec3(scale * (offset + Vec3(whole(random), whole(random), whole(random))));
    };
    const std::array<Vec3, 4> c{point(), point(), point(), point()};
    Vec3 e = point();
    e[i % 3] = std::nextafter(e[i % 3], e[i % 3] + nudge(random) * scale);
    const Sign expected = in_sphere_slow(c, e);
    zeros += expected == Sign::Zero ? 1 : 0;
    ASSERT_EQ(in_sphere(c[0], c[1], c[2], c[3], e), expected) << i;
  }
  EXPECT_GT(zeros, 20);
}

TEST(SelfIntersections, AreNoneOfWhatIsEmbedded) {
  for (const Mesh& mesh : {test::icosphere(3), test::box({1, 2, 3}, 4), test::uv_sphere(20, 12)}) {
    const SelfIntersections found = self_intersections(mesh);
    EXPECT_TRUE(found.none()) << found.triangles << ' ' << found.flat;
  }
}

TEST(SelfIntersections, AreFound) {
  const Mesh sphere = test::icosphere(2);
  EXPECT_GT(
      self_intersections(test::merged({sphere, test::translated(sphere, {0.7, 0, 0})})).triangles,
      10U);
  // The same surface twice, and one that touches another with a corner.
  EXPECT_EQ(self_intersections(test::merged({sphere, sphere})).triangles,
            2 * sphere.triangles.size());
  Mesh two;
  two.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}, {1, 0, 1}, {0, 1, 1}};
  two.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(self_intersections(two).triangles, 2U);
  two.vertices[3].z() = 0x1p-1000;
  EXPECT_EQ(self_intersections(two).triangles, 0U);
  // Folded onto each other along a common edge.
  two.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.3, 0}};
  two.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(self_intersections(two).triangles, 2U);
  two.vertices[3].y() = -0.3;
  EXPECT_EQ(self_intersections(two).triangles, 0U);
  // A common corner, and the side opposite to it crosses.
  two.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, -1}, {1, 1, 1}};
  two.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(self_intersections(two).triangles, 2U);
  two.triangles = {{0, 1, 2}, {0, 1, 1}};
  EXPECT_EQ(self_intersections(two).flat, 1U);
}

}  // namespace
}  // namespace kaboum::geom
