#include "arms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kaboum::test {
namespace {

using Matrix = std::array<std::array<long double, 4>, 4>;
constexpr double kQuarter = std::numbers::pi / 2;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

Matrix about_z(long double angle, long double d) {
  const long double c = std::cos(angle), s = std::sin(angle);
  return {{{c, -s, 0, 0}, {s, c, 0, 0}, {0, 0, 1, d}, {0, 0, 0, 1}}};
}

Matrix about_x(long double angle, long double a) {
  const long double c = std::cos(angle), s = std::sin(angle);
  return {{{1, 0, 0, a}, {0, c, -s, 0}, {0, s, c, 0}, {0, 0, 0, 1}}};
}

Matrix matrix_of(const Transform& t) {
  Matrix m{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m[i][j] = t.linear(i, j);
    m[i][3] = t.translation[i];
  }
  m[3][3] = 1;
  return m;
}

Transform transform_of(const Matrix& m) {
  Transform t;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) t.linear(i, j) = static_cast<double>(m[i][j]);
    t.translation[i] = static_cast<double>(m[i][3]);
  }
  return t;
}

/// α of rows, from those of the distal convention to those of the proximal one: each row's turn
/// about x comes first, so they move on by one.
std::vector<Dh> to_proximal(const std::vector<Dh>& distal, Transform& tool) {
  std::vector<Dh> rows(distal.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].theta = distal[i].theta;
    rows[i].d = distal[i].d;
    if (i > 0) {
      rows[i].a = distal[i - 1].a;
      rows[i].alpha = distal[i - 1].alpha;
    }
  }
  tool = transform_of(
      matrix_of(robot::dh_proximal({0, 0, distal.back().a, distal.back().alpha}) * tool));
  return rows;
}

}  // namespace

Transform random_pose(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> unit(-1, 1);
  return {robot::rotation_from_rpy(3 * unit(random), 1.5 * unit(random), 3 * unit(random)),
          size * Vec3(unit(random), unit(random), unit(random))};
}

std::vector<double> random_joints(std::mt19937_64& random, std::size_t n, double range) {
  std::uniform_real_distribution<double> value(-range, range);
  std::vector<double> q(n);
  for (double& x : q) x = value(random);
  return q;
}

Arm arm_of(const DhArm& dh) {
  Arm arm = dh.distal ? arm_of_distal(dh.rows) : arm_of_proximal(dh.rows);
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    Axis& axis = arm.axes[i];
    axis.direction = dh.base.linear * axis.direction;
    axis.point = dh.base * axis.point;
    if (!dh.sign.empty() && dh.sign[i] < 0) axis.direction = -axis.direction;
  }
  arm.tool = dh.base * arm.tool * dh.tool;
  return arm;
}

Transform reference_pose(const DhArm& dh, const std::vector<double>& q) {
  Matrix m = matrix_of(dh.base);
  for (std::size_t i = 0; i < dh.rows.size(); ++i) {
    const Dh& r = dh.rows[i];
    const long double sign = dh.sign.empty() ? 1 : dh.sign[i];
    const Matrix turn = about_z(sign * static_cast<long double>(q[i]) + r.theta, r.d);
    const Matrix twist = about_x(r.alpha, r.a);
    m = dh.distal ? product(product(m, turn), twist) : product(product(m, twist), turn);
  }
  return transform_of(product(m, matrix_of(dh.tool)));
}

DhArm random_arm(Family family, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1), size(0.2, 1);
  std::bernoulli_distribution coin;
  const auto length = [&] { return coin(random) ? unit(random) : 0.0; };  // often 0
  const auto quarter = [&] { return coin(random) ? kQuarter : -kQuarter; };
  const auto half = [&] { return coin(random) ? 0.0 : std::numbers::pi; };
  const auto sign = [&](double x) { return coin(random) ? x : -x; };
  DhArm arm;
  if (family == Family::SphericalWrist)
    arm.rows = {{0, length(), length(), quarter()},
                {0, length(), sign(size(random)), half()},
                {0, length(), length(), quarter()},
                {0, sign(size(random)), 0, quarter()},
                {0, 0, 0, quarter()},
                {0, length(), 0, 0}};
  else
    arm.rows = {{0, length(), length(), quarter()},
                {0, length(), sign(size(random)), half()},
                {0, length(), sign(size(random)), half()},
                {0, length(), length(), quarter()},
                {0, length(), 0, quarter()},
                {0, length(), 0, 0}};
  if (family == Family::FiveAxes) arm.rows.resize(5);
  for (Dh& row : arm.rows) {
    row.theta = 3 * unit(random);
    arm.sign.push_back(sign(1));
  }
  if (coin(random)) arm.base = random_pose(random, 1);
  if (coin(random)) arm.tool = random_pose(random, 0.5);
  arm.distal = coin(random);
  if (!arm.distal) arm.rows = to_proximal(arm.rows, arm.tool);
  return arm;
}

DhArm rv_6sl(bool distal) {
  const double degree = std::numbers::pi / 180;
  DhArm arm;
  arm.rows = {{0, .35, .085, -kQuarter},        {-90 * degree, 0, .38, 0},
              {-90 * degree, 0, .1, -kQuarter}, {0, .425, 0, kQuarter},
              {180 * degree, 0, 0, kQuarter},   {0, .085, 0, 0}};
  arm.distal = distal;
  if (!distal) arm.rows = to_proximal(arm.rows, arm.tool);
  return arm;
}

double turn_distance(const double* a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < b.size(); ++i)
    most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2 * std::numbers::pi)));
  return most;
}

}  // namespace kaboum::test
