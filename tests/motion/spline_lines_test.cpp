// Straight lines near polynomials between waypoints: nothing of the polynomials is farther from
// them than is said.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/motion/spline_lines.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace kaboum::motion {
namespace {

using Values = std::vector<double>;

SplineWaypoints random_spline(std::uint32_t seed, bool quintic) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-2, 2), time(1e-3, 2);
  const std::size_t joints = 1 + random() % 5, count = 1 + random() % 5;
  const double far = random() % 5 == 0 ? 1e4 : 0;
  SplineWaypoints out;
  const auto row = [&](double size) {
    Values q(joints);
    for (double& x : q) x = random() % 6 == 0 ? 0 : size * value(random);
    return q;
  };
  for (std::size_t i = 0; i < count; ++i) {
    out.times.push_back(i == 0 ? value(random) + 2 : out.times.back() + time(random));
    out.positions.push_back(row(1));
    for (double& x : out.positions.back()) x += far;
    out.velocities.push_back(row(3));
    if (quintic) out.accelerations.push_back(row(20));
  }
  return out;
}

/// By powers of the share of the time, unlike the lines.
long double value_at(const SplineWaypoints& s, std::size_t i, std::size_t j, long double u) {
  const long double h = static_cast<long double>(s.times[i + 1]) - s.times[i],
                    d = static_cast<long double>(s.positions[i + 1][j]) - s.positions[i][j],
                    v0 = h * s.velocities[i][j], v1 = h * s.velocities[i + 1][j];
  if (s.accelerations.empty())
    return s.positions[i][j] + u * (v0 + u * (3 * d - 2 * v0 - v1 + u * (v0 + v1 - 2 * d)));
  const long double a0 = h * h * s.accelerations[i][j], a1 = h * h * s.accelerations[i + 1][j],
                    c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5L * a0 + 0.5L * a1,
                    c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5L * a0 - a1,
                    c5 = 6 * d - 3 * (v0 + v1) + 0.5L * (a1 - a0);
  return s.positions[i][j] + u * (v0 + u * (0.5L * a0 + u * (c3 + u * (c4 + u * c5))));
}

TEST(SplineLines, NothingIsFartherFromThemThanIsSaid) {
  double farthest = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    const SplineWaypoints s = random_spline(seed, seed % 2 == 0);
    std::mt19937_64 random(seed);
    const double within = std::exp2(-static_cast<double>(random() % 16));
    std::vector<std::size_t> parts = spline_parts(s, within);
    const bool coarse = seed % 3 == 0;  // fewer or more than are needed
    for (std::size_t& p : parts)
      if (coarse) p = 1 + random() % 7;
    const SplineLines lines = spline_lines(s, parts);
    ASSERT_EQ(lines.waypoints.size(), s.positions.size());
    for (std::size_t i = 0; i < s.positions.size(); ++i)
      ASSERT_EQ(lines.points[lines.waypoints[i]], s.positions[i]);
    for (std::size_t j = 0; j < lines.around.size(); ++j) {
      if (!coarse) {
        ASSERT_LE(lines.around[j], within * (1 + 1e-6) + 1e-9) << seed;
      }
      for (std::size_t k = 0; k + 1 < lines.points.size(); ++k)
        for (int part = 0; part <= 16; ++part) {
          const double share = part / 16.0;
          const auto [waypoint, u] = lines.place(k, share);
          ASSERT_LT(waypoint + 1, s.positions.size());
          const long double line =
              lines.points[k][j] +
              static_cast<long double>(share) *
                  (static_cast<long double>(lines.points[k + 1][j]) - lines.points[k][j]);
          const double off = static_cast<double>(std::abs(value_at(s, waypoint, j, u) - line));
          ASSERT_LE(off, lines.around[j]) << seed << ", joint " << j << ", line " << k;
          if (lines.around[j] > 1e-6) farthest = std::max(farthest, off / lines.around[j]);
        }
    }
  }
  EXPECT_GT(farthest, 0.9);  // and the bound is nearly reached
}

TEST(SplineLines, PlacesAreOfTheWaypoints) {
  const SplineWaypoints s{{0, 1, 3}, {{0}, {1}, {0}}, {{0}, {0}, {0}}};
  const SplineLines lines = spline_lines(s, std::vector<std::size_t>{2, 4});
  EXPECT_EQ(lines.points.size(), 7U);
  EXPECT_EQ(lines.waypoints, (std::vector<std::size_t>{0, 2, 6}));
  EXPECT_EQ(lines.place(1, 0.5), (std::pair<std::size_t, double>{0, 0.75}));
  EXPECT_EQ(lines.place(2, 0), (std::pair<std::size_t, double>{1, 0}));
  EXPECT_EQ(lines.place(5, 1), (std::pair<std::size_t, double>{1, 1}));
  EXPECT_EQ(lines.place(6, 0), (std::pair<std::size_t, double>{2, 0}));
}

TEST(SplineLines, StraightMotionsNeedOne) {
  const SplineWaypoints s{{0, 2}, {{0, 5}, {1, 5}}, {{0.5, 0}, {0.5, 0}}, {{0, 0}, {0, 0}}};
  EXPECT_EQ(spline_parts(s, 1e-9), (std::vector<std::size_t>{1}));
  const SplineLines lines = spline_lines(s, std::vector<std::size_t>{1});
  for (const double room : lines.around) EXPECT_LT(room, 1e-12);
  // What stands has the same value at each point.
  for (const Values& q : spline_lines(s, std::vector<std::size_t>{7}).points) EXPECT_EQ(q[1], 5);
}

TEST(SplineLines, WhatIsNoPolynomialIsRefused) {
  const auto code = [](const SplineWaypoints& s, double within) {
    try {
      spline_parts(s, within);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::Internal;
  };
  const Values still{0};
  EXPECT_EQ(code({{0, 0}, {{0}, {1}}, {still, still}}, 1e-5), ErrorCode::InvalidInput);
  EXPECT_EQ(code({{1, 0}, {{0}, {1}}, {still, still}}, 1e-5), ErrorCode::InvalidInput);
  EXPECT_EQ(code({{0, 1}, {{0}, {1}}, {still}}, 1e-5), ErrorCode::InvalidArgument);
  EXPECT_EQ(code({{0, 1}, {{0}, {1}}, {still, {0, 0}}}, 1e-5), ErrorCode::InvalidArgument);
  EXPECT_EQ(code({{0, 1}, {{0}, {1}}, {still, {std::numeric_limits<double>::infinity()}}}, 1e-5),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(code({{0, 1}, {{0}, {1}}, {still, still}}, 0), ErrorCode::InvalidArgument);
  EXPECT_EQ(code({{0, 1e200}, {{0}, {1}}, {still, {1}}}, 1e-5), ErrorCode::InvalidInput);
  EXPECT_EQ(code({{0, 1}, {{0}, {1}}, {still, still}}, 1e-15), ErrorCode::LimitReached);
}

}  // namespace
}  // namespace kaboum::motion
