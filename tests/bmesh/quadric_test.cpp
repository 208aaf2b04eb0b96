#include "quadric.h"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace kaboum::bmesh;  // NOLINT: the test is about these few names

Vec3 random_vector(std::mt19937_64& random, double scale = 1) {
  std::normal_distribution<double> n(0, scale);
  return {n(random), n(random), n(random)};
}

TEST(Quadric, MeasuresSquaredDistances) {
  std::mt19937_64 random(21);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = random_vector(random), x = random_vector(random),
               n = random_vector(random).normalized();
    EXPECT_NEAR(point_quadric(p)(x), (x - p).squaredNorm(), 1e-12);
    EXPECT_NEAR(plane_quadric(p, n)(x), std::pow(n.dot(x - p), 2), 1e-12);
    const Quadric sum = point_quadric(p) + plane_quadric(p, n);
    EXPECT_NEAR(sum(x), (x - p).squaredNorm() + std::pow(n.dot(x - p), 2), 1e-12);
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = h * Vec3::Unit(k);
      EXPECT_NEAR(sum.half_gradient(x)[k], (sum(x + e) - sum(x - e)) / (4 * h), 1e-7);
    }
  }
}

// The counterexample to "Q1 + Q2 − max(Q1(m), Q2(m)) bounds min(Q1, Q2) from above".
TEST(AddAdapted, TouchesTheMinimumAndIsNoUpperBound) {
  Quadric q1, q2;
  q1.xx = 4;
  q2 = plane_quadric(Vec3(1, 0, 0), Vec3::UnitX());
  const Quadric q = add_adapted(q1, q2);
  const auto at = [](double x) { return Vec3(x, 0, 0); };
  EXPECT_NEAR(q(at(0.2)), std::min(q1(at(0.2)), q2(at(0.2))), 1e-12);
  EXPECT_NEAR(q(at(0.21)), 0.1605, 1e-12);
  EXPECT_NEAR(std::min(q1(at(0.21)), q2(at(0.21))), 0.1764, 1e-12);
}

TEST(AddDiagonal, BoundsBothWhenCorrected) {
  std::mt19937_64 random(22);
  int printed_fails = 0;
  for (int i = 0; i < 200; ++i) {
    Quadric q1, q2;
    for (int k = 0; k < 4; ++k) {
      q1 += plane_quadric(random_vector(random), random_vector(random).normalized());
      q2 += plane_quadric(random_vector(random), random_vector(random).normalized());
    }
    const Quadric q = add_diagonal(q1, q2, 0.5, false);
    const Quadric printed = add_diagonal(q1, q2, 0.5, true);
    bool printed_bounds = true;
    for (int k = 0; k < 200; ++k) {
      const Vec3 x = random_vector(random, 5);
      const double larger = std::max(q1(x), q2(x));
      ASSERT_GE(q(x), larger * (1 - 1e-9)) << "case " << i;
      printed_bounds = printed_bounds && printed(x) >= larger * (1 - 1e-9);
    }
    printed_fails += !printed_bounds;
  }
  EXPECT_GT(printed_fails, 0) << "Eq. 4.6 as printed should fail somewhere";
}

TEST(AddDiagonal, DoesNotDependOnTheFrame) {
  std::mt19937_64 random(23);
  const Vec3 p = random_vector(random), n = random_vector(random).normalized(),
             m = random_vector(random).normalized();
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  const Vec3 shift(1, -2, 0.5);
  const auto moved = [&](const Vec3& x) { return Vec3(turn * x + shift); };
  const Quadric q =
      add_diagonal(plane_quadric(p, n) + point_quadric(p), plane_quadric(-p, m), 0.3, false);
  const Quadric r = add_diagonal(plane_quadric(moved(p), turn * n) + point_quadric(moved(p)),
                                 plane_quadric(moved(-p), turn * m), 0.3, false);
  for (int i = 0; i < 50; ++i) {
    const Vec3 x = random_vector(random);
    EXPECT_NEAR(q(x), r(moved(x)), 1e-9 * (1 + q(x)));
  }
}

}  // namespace
