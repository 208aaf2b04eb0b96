#include <kaboum/geom/predicates.h>

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <random>

namespace {

using kaboum::geom::orient2d;
using kaboum::geom::orient3d;
using kaboum::geom::Sign;
using kaboum::geom::Vec3;
using Rational = boost::multiprecision::cpp_rational;

Sign sign_of(const Rational& r) { return static_cast<Sign>(r.sign()); }

Sign orient3d_slow(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Rational m[3][3];
  for (int k = 0; k < 3; ++k) {
    m[0][k] = Rational(b[k]) - Rational(a[k]);
    m[1][k] = Rational(c[k]) - Rational(a[k]);
    m[2][k] = Rational(d[k]) - Rational(a[k]);
  }
  return sign_of(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                 m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                 m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
}

TEST(Orient3d, IsPositiveOnTheOuterSide) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(orient3d(a, b, c, Vec3(0, 0, 1)), Sign::Positive);
  EXPECT_EQ(orient3d(a, b, c, Vec3(0, 0, -1)), Sign::Negative);
  EXPECT_EQ(orient3d(a, b, c, Vec3(5, 7, 0)), Sign::Zero);
}

// Points near a common plane, at many scales and offsets: the filter must hand over what it cannot
// decide, and what it decides must agree with rational arithmetic.
TEST(Orient3d, AgreesWithRationalsNearDegeneracy) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::uniform_int_distribution<int> exponent(-60, 60), nudge(-3, 3);
  std::uint64_t exact = 0;
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::ldexp(1.0, i % 3 == 0 ? exponent(random) : 0);
    const Vec3 offset = i % 2 == 0 ? Vec3(1e3, -2e3, 5e2) : Vec3(0, 0, 0);
    const auto point = [&] {
      return Vec3(scale * (offset + Vec3(unit(random), unit(random), unit(random))));
    };
    const Vec3 a = point(), b = point(), c = point();
    Vec3 d = a + unit(random) * (b - a) + unit(random) * (c - a);
    for (int k = 0; k < 3; ++k)
      for (int n = nudge(random); n != 0; n += n > 0 ? -1 : 1)
        d[k] = std::nextafter(d[k], n * 1e300);
    const Sign expected = orient3d_slow(a, b, c, d);
    zeros += expected == Sign::Zero;
    ASSERT_EQ(orient3d(a, b, c, d, &exact), expected) << "case " << i;
    ASSERT_EQ(orient3d(a, b, c, a + (b - a)), orient3d_slow(a, b, c, a + (b - a)));
  }
  EXPECT_GT(exact, 1000U);
}

TEST(Orient3d, SurvivesUnderflowAndOverflow) {
  for (const double s : {1e-320, 1e-160, 1e-110, 1e100, 1e150}) {
    const Vec3 a(0, 0, 0), b(s, 0, 0), c(0, s, 0);
    EXPECT_EQ(orient3d(a, b, c, Vec3(0, 0, s)), Sign::Positive) << s;
    EXPECT_EQ(orient3d(a, b, c, Vec3(s, s, -s)), Sign::Negative) << s;
    EXPECT_EQ(orient3d(a, b, c, Vec3(s, s, 0)), Sign::Zero) << s;
  }
  // A tiny factor beside a huge one.
  EXPECT_EQ(
      orient3d(Vec3(0, 0, 0), Vec3(1e-200, 0, 0), Vec3(0, 1e-200, 0), Vec3(1e200, 1e200, 1e-300)),
      Sign::Positive);
}

TEST(Orient2d, AgreesWithRationalsNearDegeneracy) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const double ax = unit(random), ay = unit(random), bx = unit(random), by = unit(random);
    const double t = unit(random);
    const double cx = ax + t * (bx - ax), cy = ay + t * (by - ay);
    const Rational slow = (Rational(bx) - Rational(ax)) * (Rational(cy) - Rational(ay)) -
                          (Rational(by) - Rational(ay)) * (Rational(cx) - Rational(ax));
    ASSERT_EQ(orient2d(ax, ay, bx, by, cx, cy), sign_of(slow));
  }
}

}  // namespace
