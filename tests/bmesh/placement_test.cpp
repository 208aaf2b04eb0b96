#include "placement.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace {

using kaboum::bmesh::HalfSpace;
using kaboum::bmesh::kRegularisation;
using kaboum::bmesh::minimise;
using kaboum::bmesh::plane_quadric;
using kaboum::bmesh::Quadric;
using kaboum::bmesh::Vec3;

/// The thesis's Algorithm 1: every subset of up to three planes taken as active, by the Lagrangian
/// system solved with full pivoting; the cheapest feasible candidate wins.
struct Exhaustive {
  Eigen::Matrix3d a;
  Vec3 b;
  const std::vector<HalfSpace>& planes;

  Exhaustive(const Quadric& q, const Vec3& linear, const std::vector<HalfSpace>& half_spaces)
      : planes(half_spaces) {
    a << q.xx, q.xy, q.xz, q.xy, q.yy, q.yz, q.xz, q.yz, q.zz;
    a /= q.trace();
    a.diagonal().array() += kRegularisation;
    b = linear / q.trace();
  }

  [[nodiscard]] double cost(const Vec3& y) const { return y.dot(a * y) + 2 * b.dot(y); }

  [[nodiscard]] double violation(const Vec3& y) const {
    double worst = 0;
    for (const HalfSpace& h : planes) worst = std::max(worst, h.offset - h.normal.dot(y));
    return worst;
  }

  [[nodiscard]] std::optional<Vec3> with_active(const std::vector<std::size_t>& active) const {
    const auto n = static_cast<Eigen::Index>(active.size());
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(3 + n, 3 + n);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(3 + n);
    k.topLeftCorner<3, 3>() = 2 * a;
    r.head<3>() = -2 * b;
    for (Eigen::Index i = 0; i < n; ++i) {
      const HalfSpace& h = planes[active[static_cast<std::size_t>(i)]];
      k.block<3, 1>(0, 3 + i) = -h.normal;
      k.block<1, 3>(3 + i, 0) = h.normal.transpose();
      r[3 + i] = h.offset;
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(k);
    if (lu.rank() < 3 + n) return std::nullopt;
    return Vec3(lu.solve(r).head<3>());
  }

  [[nodiscard]] std::optional<Vec3> solve(double tolerance) const {
    std::optional<Vec3> best;
    const auto consider = [&](const std::vector<std::size_t>& active) {
      const auto y = with_active(active);
      if (y && violation(*y) <= tolerance * (1 + y->norm()) && (!best || cost(*y) < cost(*best)))
        best = y;
    };
    consider({});
    const std::size_t n = planes.size();
    for (std::size_t i = 0; i < n; ++i) {
      consider({i});
      for (std::size_t j = i + 1; j < n; ++j) {
        consider({i, j});
        for (std::size_t k = j + 1; k < n; ++k) consider({i, j, k});
      }
    }
    return best;
  }
};

struct Problem {
  Quadric quadric;
  Vec3 linear;
  std::vector<HalfSpace> planes;
};

/// Planes around a bumpy star; `spread` small makes them nearly parallel.
Problem random_problem(std::mt19937_64& random, double spread, int planes) {
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  Problem p;
  const Vec3 up = vector().normalized();
  for (int i = 0; i < planes; ++i) {
    const Vec3 n = (up + spread * vector()).normalized();
    p.quadric += plane_quadric(0.3 * vector(), n);
    p.planes.push_back({n, 0.2 * normal(random)});
  }
  p.quadric += plane_quadric(vector(), vector().normalized());
  p.linear = p.quadric.half_gradient(Vec3::Zero());
  return p;
}

TEST(Placement, EqualsExhaustiveEnumeration) {
  std::mt19937_64 random(11);
  int solved = 0, infeasible = 0;
  std::array<int, 4> active{};
  for (int i = 0; i < 3000; ++i) {
    const double spread = std::pow(10.0, -(i % 5));  // 1 … 1e-4
    const Problem p = random_problem(random, spread, 3 + i % 10);
    const Exhaustive reference(p.quadric, p.linear, p.planes);
    const auto expected = reference.solve(1e-9);
    const auto y = minimise(p.quadric, p.linear, p.planes);
    if (!expected) {
      if (!y) ++infeasible;
      continue;
    }
    ASSERT_TRUE(y) << "case " << i;
    ++solved;
    ASSERT_LE(reference.violation(*y), 1e-8 * (1 + y->norm())) << "case " << i;
    const double scale = 1 + y->squaredNorm();
    ASSERT_NEAR(reference.cost(*y), reference.cost(*expected), 1e-7 * scale) << "case " << i;
    int tight = 0;
    for (const HalfSpace& h : p.planes)
      tight += std::abs(h.normal.dot(*y) - h.offset) < 1e-9 * (1 + y->norm());
    ++active[static_cast<std::size_t>(std::min(tight, 3))];
  }
  EXPECT_GT(solved, 2500);
  for (int m = 0; m < 4; ++m)
    EXPECT_GT(active[static_cast<std::size_t>(m)], 10) << m << " active planes";
}

TEST(Placement, ReportsInfeasibility) {
  Quadric q = plane_quadric(Vec3::Zero(), Vec3::UnitX());
  const std::vector<HalfSpace> gap{{Vec3::UnitZ(), 1}, {-Vec3::UnitZ(), 1}};
  EXPECT_FALSE(minimise(q, Vec3::Zero(), gap));
  const std::vector<HalfSpace> wedge{
      {Vec3(1, 0, 1).normalized(), 1}, {Vec3(-1, 0, 1).normalized(), 1}, {-Vec3::UnitZ(), 0}};
  EXPECT_FALSE(minimise(q, Vec3::Zero(), wedge));
}

TEST(Placement, StaysPutWhereTheQuadricIsIndifferent) {
  const Quadric q = plane_quadric(Vec3::Zero(), Vec3::UnitZ());
  const auto y = minimise(q, Vec3::Zero(), {});
  ASSERT_TRUE(y);
  EXPECT_LT(y->norm(), 1e-12);
}

TEST(Placement, ManyPlanesAreNoLimit) {
  std::mt19937_64 random(12);
  const Problem p = random_problem(random, 0.2, 200);
  const auto y = minimise(p.quadric, p.linear, p.planes);
  ASSERT_TRUE(y);
  for (const HalfSpace& h : p.planes) EXPECT_GE(h.normal.dot(*y), h.offset - 1e-9);
}

}  // namespace
