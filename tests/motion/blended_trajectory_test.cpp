// Trajectories with blended corners: curves, limits by differences of samples, what is certified.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/motion/blended_path.h>
#include <kaboum/motion/find_path.h>
#include <kaboum/motion/sampled_path.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <sstream>
#include <tuple>
#include <utility>

#include "random_scene.h"
#include "world/worlds.h"

namespace kaboum::motion {
namespace {

using Values = std::vector<double>;

struct Corners {
  robot::Path path;
  SpeedLimits limits;
  Values shares;
};

constexpr std::array kTiny{1e-300, 1e-16, 1e-13, 1e-9, 1e-4};

Corners random_corners(std::uint32_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-2, 2), limit(0.3, 6), share(0, kMostBlend);
  Corners out;
  const std::size_t joints = 1 + random() % 6, waypoints = 2 + random() % 6;
  for (std::size_t i = 0; i < waypoints; ++i) {
    Values q(joints);
    for (double& x : q) x = value(random);
    if (i > 0 && random() % 6 == 0) q = out.path.back();
    if (i > 0 && random() % 8 == 0)
      for (std::size_t j = 0; j < joints; ++j)
        q[j] = out.path.back()[j] + (q[j] - out.path.back()[j]) * kTiny[random() % kTiny.size()];
    if (i > 0 && random() % 4 == 0) q[0] = out.path.back()[0];
    out.path.push_back(q);
    const std::uint64_t kind = random() % 4;
    out.shares.push_back(kind == 0 ? 0 : kind == 1 ? 0.5 : share(random));
  }
  for (std::size_t j = 0; j < joints; ++j) {
    out.limits.velocity.push_back(limit(random));
    out.limits.acceleration.push_back(2 * limit(random));
    out.limits.jerk.push_back(20 * limit(random));
  }
  return out;
}

/// Segments that take equally long at full speed, all of which is blends: speeds change within
/// these. Jerks are hardly limited: accelerations are what counts.
Corners equal_segments(std::uint32_t seed) {
  Corners out = random_corners(seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Values q(out.path[0].size() + 1, 0), direction = q;
  out.path.clear();
  direction[0] = 1;
  for (int i = 0; i < 8; ++i) {
    out.path.push_back(q);
    double length = 0;
    for (double& x : direction) x = x / 2 + value(random) * (1 + i % 3) / 4;
    for (const double x : direction) length = std::max(length, std::abs(x));
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += direction[j] / length / 4;
  }
  out.shares.assign(out.path.size(), 0.5);
  out.limits = {Values(q.size(), 1), Values(q.size(), 2), Values(q.size(), 1000)};
  return out;
}

double farthest(const Values& a, const Values& b) {
  double out = 0;
  for (std::size_t j = 0; j < a.size(); ++j) out = std::max(out, std::abs(a[j] - b[j]));
  return out;
}

/// How far a point is from the nearest one of a segment.
double distance_to_segment(const Values& q, const Values& a, const Values& b) {
  double along = 0, whole = 0, out = 0;
  for (std::size_t j = 0; j < q.size(); ++j) {
    along += (q[j] - a[j]) * (b[j] - a[j]);
    whole += (b[j] - a[j]) * (b[j] - a[j]);
  }
  const double share = whole > 0 ? std::clamp(along / whole, 0.0, 1.0) : 0;
  for (std::size_t j = 0; j < q.size(); ++j)
    out = std::hypot(out, q[j] - a[j] - share * (b[j] - a[j]));
  return out;
}

TEST(BlendedPath, BlendsAreInTheTrianglesOfTheirCorners) {
  std::size_t blends = 0, larger = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const Corners c = random_corners(seed);
    const BlendedPath curve(c.path, c.shares, c.limits.velocity);
    for (const PathPiece& piece : curve.pieces()) {
      if (!piece.is_blend) continue;
      ++blends;
      const Values begin = piece.at(0).q, end = piece.at(piece.length).q,
                   &corner = c.path[piece.waypoint];
      std::size_t before = piece.waypoint - 1, after = piece.waypoint + 1;
      while (farthest(c.path[before], corner) <= 1e-14) --before;
      while (farthest(c.path[after], corner) <= 1e-14) ++after;
      // Of the segments it takes no more than it may. (Two of one segment do not overlap: else
      // their pieces would not join.)
      const double share = c.shares[piece.waypoint];
      EXPECT_LE(farthest(begin, corner), share * farthest(c.path[before], corner) + 1e-14);
      EXPECT_LE(farthest(end, corner), share * farthest(c.path[after], corner) + 1e-14);
      larger += farthest(begin, corner) > 0.6 * farthest(c.path[before], corner) ? 1 : 0;
      EXPECT_LE(distance_to_segment(begin, c.path[before], corner), 1e-12);
      EXPECT_LE(distance_to_segment(end, c.path[after], corner), 1e-12);
      for (int k = 0; k <= 20; ++k) {
        const double u = k / 20.0;
        Values mean(corner.size());
        for (std::size_t j = 0; j < mean.size(); ++j)
          mean[j] = (1 - u) * (1 - u) * begin[j] + 2 * u * (1 - u) * corner[j] + u * u * end[j];
        ASSERT_LE(farthest(piece.at(piece.length * u).q, mean), 1e-13) << seed;
      }
    }
  }
  EXPECT_GT(blends, 200U);
  EXPECT_GT(larger, 10U);
}

TEST(BlendedPath, IsContinuouslyDifferentiableBetweenStops) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const Corners c = random_corners(seed);
    const BlendedPath curve(c.path, c.shares, c.limits.velocity);
    const std::vector<PathPiece>& pieces = curve.pieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const PathPiece& piece = pieces[i];
      const CurvePoint end = piece.at(piece.length);
      const bool stops =
          std::find(curve.stops().begin(), curve.stops().end(), i + 1) != curve.stops().end();
      const auto size = [](const Values& x) { return farthest(x, Values(x.size(), 0)); };
      if (!stops) {
        const CurvePoint next = pieces[i + 1].at(0);
        EXPECT_LE(farthest(end.q, next.q), 1e-12);
        EXPECT_LE(farthest(end.first, next.first), 1e-9 * (size(end.first) + size(piece.in)));
      }
      // The derivatives are those of the points; of shorter pieces these are rounded too far.
      if (farthest(piece.at(0).q, end.q) < 1e-2) continue;
      const double h = 1e-4 * piece.length;
      for (const double s : {0.2, 0.5, 0.71}) {
        const CurvePoint a = piece.at(s * piece.length - h), b = piece.at(s * piece.length),
                         d = piece.at(s * piece.length + h);
        for (std::size_t j = 0; j < b.q.size(); ++j) {
          EXPECT_NEAR((d.q[j] - a.q[j]) / (2 * h), b.first[j], 1e-6 * size(piece.in) + 1e-9 / h);
          EXPECT_NEAR((d.first[j] - a.first[j]) / (2 * h), b.second[j],
                      1e-6 * (size(piece.in) + size(piece.out)) / piece.length);
        }
      }
    }
  }
}

/// Differences of samples: those of order n, divided by the time between samples to the n, are
/// means of the derivative.
double largest_difference(robot::Path rows, std::size_t joint, int order, double rate) {
  double out = 0;
  for (int n = 0; n < order; ++n) {
    for (std::size_t k = 0; k + 1 < rows.size(); ++k)
      rows[k][joint] = (rows[k + 1][joint] - rows[k][joint]) * rate;
    if (!rows.empty()) rows.pop_back();
  }
  for (const Values& row : rows) out = std::max(out, std::abs(row[joint]));
  return out;
}

TEST(BlendedTrajectory, DifferencesOfSamplesKeepAllLimits) {
  std::size_t tight = 0, count = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    Corners c = seed % 3 == 0 ? equal_segments(seed) : random_corners(seed);
    const double rate = seed % 2 == 0 ? 1000 : 250;
    const Trajectory t(c.path, c.shares, c.limits, rate);
    EXPECT_EQ(t.sample(0), c.path.front());
    EXPECT_EQ(t.sample(t.samples() - 1), c.path.back());
    robot::Path rows;
    for (std::size_t k = 0; k < t.samples(); ++k) rows.push_back(t.sample(k));
    double velocity = 0, acceleration = 0, jerk = 0;
    for (std::size_t j = 0; j < c.path[0].size(); ++j) {
      velocity = std::max(velocity, largest_difference(rows, j, 1, rate) / c.limits.velocity[j]);
      acceleration =
          std::max(acceleration, largest_difference(rows, j, 2, rate) / c.limits.acceleration[j]);
      jerk = std::max(jerk, largest_difference(rows, j, 3, rate) / c.limits.jerk[j]);
    }
    // Third differences of values up to 2 have roundings of up to 8 · 2⁻⁵³ · 2 · 10⁹.
    EXPECT_LE(velocity, 1 + 1e-9) << seed;
    EXPECT_LE(acceleration, 1 + 1e-6) << seed;
    EXPECT_LE(jerk, 1 + 1e-5) << seed;
    if (t.samples() < 2) continue;
    ++count;
    tight += std::max({velocity, acceleration, jerk}) > 0.95 ? 1 : 0;
  }
  EXPECT_GT(tight, count * 9 / 10) << "needlessly slow";
}

TEST(BlendedTrajectory, InstantsAreThoseOfTheValuesAndContinuous) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Corners c = random_corners(seed);
    const Trajectory t(c.path, c.shares, c.limits, 1000);
    const double h = 1e-6;
    for (double time = h; time + h < t.duration(); time += 0.00713) {
      const Instant before = t.at(time - h), now = t.at(time), after = t.at(time + h);
      for (std::size_t j = 0; j < now.q.size(); ++j) {
        EXPECT_NEAR((after.q[j] - before.q[j]) / (2 * h), now.velocity[j], 1e-5);
        EXPECT_LE(std::abs(after.velocity[j] - before.velocity[j]),
                  2 * h * c.limits.acceleration[j] + 1e-9);
        EXPECT_LE(std::abs(after.acceleration[j] - before.acceleration[j]),
                  2 * h * c.limits.jerk[j] + 1e-6);
        EXPECT_NEAR((after.velocity[j] - before.velocity[j]) / (2 * h), now.acceleration[j],
                    h * c.limits.jerk[j] + 1e-5);
      }
    }
    for (const std::size_t end : {std::size_t{0}, t.samples() - 1}) {
      EXPECT_EQ(t.instant(end).q, t.sample(end));
      EXPECT_EQ(t.instant(end).velocity, Values(c.path[0].size(), 0));
      EXPECT_EQ(t.instant(end).acceleration, Values(c.path[0].size(), 0));
    }
    for (std::size_t i = 1; i < c.path.size(); ++i) EXPECT_LE(t.time_at(i - 1), t.time_at(i));
    EXPECT_EQ(t.time_at(c.path.size() - 1), t.duration());
  }
}

/// Segments that grow by less than a half each, and begin short again: the scale of the parameter
/// would grow with each of them.
Corners sawtooth(std::uint32_t seed, std::size_t waypoints) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> turn(-1, 1), growth(1.1, 1.6);
  Corners out;
  const bool falls = seed % 2 == 0;
  Values q(2, 0);
  double length = 1e-3, direction = 0;
  for (std::size_t i = 0; i < waypoints; ++i) {
    out.path.push_back(q);
    q[0] += length * std::cos(direction);
    q[1] += length * std::sin(direction);
    direction += turn(random);
    length *= growth(random);
    if (length > 0.5) length = 1e-3;
  }
  if (falls) std::ranges::reverse(out.path);
  out.shares.assign(waypoints, 0.5);
  out.limits = {Values(2, 2), Values(2, 5), Values(2, 100)};
  return out;
}

TEST(BlendedTrajectory, ThousandsOfCornersKeepTheParameterInRange) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    const Corners c = sawtooth(seed, 6000);
    const BlendedPath curve(c.path, c.shares, c.limits.velocity);
    EXPECT_EQ(curve.stops().size(), 2U);
    double least = 1e300, most = 0;
    for (std::size_t k = 0; k < curve.pieces().size(); ++k) {
      const PathPiece& piece = curve.pieces()[k];
      for (const Values* derivative : {&piece.in, &piece.out}) {
        const double size = std::hypot((*derivative)[0], (*derivative)[1]);
        least = std::min(least, size);
        most = std::max(most, size);
      }
      // Still C¹, and of ends that join.
      if (k == 0) continue;
      const CurvePoint end = curve.pieces()[k - 1].at(curve.pieces()[k - 1].length);
      for (std::size_t j = 0; j < 2; ++j) {
        EXPECT_NEAR(end.first[j], piece.in[j], 1e-9 * std::abs(end.first[j]) + 1e-12 * most);
        EXPECT_NEAR(end.q[j], piece.from[j], 1e-9);
      }
    }
    EXPECT_GT(least, 1e-10);
    EXPECT_LT(most, 1e10);
  }
  const Corners c = sawtooth(1, 1000);
  const Trajectory t(c.path, c.shares, c.limits, 100);
  EXPECT_EQ(t.time_at(999), t.duration());
  Instant before = t.instant(0);
  for (std::size_t k = 1; k < t.samples(); ++k) {
    const Instant now = t.instant(k);
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_LE(std::abs(now.q[j] - before.q[j]), 2 / t.rate() * (1 + 1e-6));
      EXPECT_LE(std::abs(now.velocity[j] - before.velocity[j]), 5 / t.rate() * (1 + 1e-6));
    }
    before = now;
  }
}

TEST(BlendedTrajectory, StopsWhereItHasToAndOnlyThere) {
  const SpeedLimits two{{1, 2}, {5, 5}, {100, 100}};
  const auto speed_at = [](const Trajectory& t, std::size_t waypoint) {
    const Instant now = t.at(t.time_at(waypoint));
    return std::max(std::abs(now.velocity[0]), std::abs(now.velocity.back()));
  };
  const Trajectory corner({{0, 0}, {1, 0}, {1, 1}}, {0, 0.5, 0}, two, 1000);
  EXPECT_GT(speed_at(corner, 1), 0.3);
  const Trajectory stop({{0, 0}, {1, 0}, {1, 1}}, {0, 0, 0}, two, 1000);
  EXPECT_EQ(speed_at(stop, 1), 0);
  EXPECT_EQ(stop.at(stop.time_at(1)).q, (Values{1, 0}));
  // Back on the same way, or nearly so.
  const Trajectory back({{0, 0}, {1, 0.5}, {0.4, 0.2}}, {0, 0.5, 0}, two, 1000);
  EXPECT_EQ(speed_at(back, 1), 0);
  EXPECT_EQ(back.at(back.time_at(1)).q, (Values{1, 0.5}));
  EXPECT_TRUE(turns_back({0, 0}, {1, 0}, {0, 0.001}, {1, 1}));
  EXPECT_FALSE(turns_back({0, 0}, {1, 0}, {0, 0.03}, {1, 1}));
  // Straight on, there is no corner: as fast as without the waypoint, but for what cells lose.
  const Trajectory on({{0, 0}, {0.5, 0}, {2, 0}}, {0, 0.5, 0}, two, 1000),
      whole({{0, 0}, {2, 0}}, {0, 0}, two, 1000);
  EXPECT_LE(on.duration(), 1.02 * whole.duration());
  EXPECT_GT(speed_at(on, 1), 0.9);
  // One joint, there and back.
  const SpeedLimits one{{1}, {5}, {100}};
  const Trajectory there({{0}, {1}, {0.5}}, {0, 0.5, 0}, one, 1000);
  EXPECT_EQ(speed_at(there, 1), 0);
  EXPECT_EQ(there.at(there.time_at(1)).q, Values{1});
}

/// Means over so short a time that their rounding would show are not taken.
TEST(BlendedTrajectory, JerksOfAnySizeKeepTheOtherLimits) {
  constexpr int kRate = 1000;
  for (const double jerk : {1e6, 1e9, 1e14, 1e300}) {
    const Trajectory moved({{0, 0}, {1, 0.3}, {1.5, 1}, {2.5, 1}}, {0, 0.5, 0.5, 0},
                           SpeedLimits{{2, 2}, {5, 5}, {jerk, jerk}}, kRate);
    double fastest = 0;
    for (std::size_t k = 0; k + 1 < moved.samples(); ++k) {
      const Instant here = moved.at(static_cast<double>(k) / kRate),
                    next = moved.at(static_cast<double>(k + 1) / kRate);
      for (std::size_t j = 0; j < 2; ++j) {
        const double by_difference = (next.q[j] - here.q[j]) * kRate;
        EXPECT_LE(std::abs(by_difference), 2 + 1e-9) << jerk;
        EXPECT_LE(std::abs(here.velocity[j]), 2) << jerk;
        EXPECT_LE(std::abs(here.acceleration[j]), 5) << jerk;
        EXPECT_LE(std::abs(next.velocity[j] - here.velocity[j]) * kRate, 5 + 1e-6) << jerk;
        EXPECT_NEAR(here.velocity[j], by_difference, 5.0 / kRate) << jerk;
        fastest = std::max(fastest, std::abs(here.velocity[j]));
      }
    }
    EXPECT_GT(fastest, 1) << jerk;
  }
}

TEST(BlendedTrajectory, WaypointsThatAreRepeatedChangeNothing) {
  const SpeedLimits two{{1, 2}, {5, 5}, {100, 100}};
  const Trajectory once({{0, 0}, {1, 0}, {1, 1}}, {0, 0.5, 0}, two, 500),
      again({{0, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 1}, {1, 1}}, {0, 0.5, 0.5, 0.5, 0.5, 0}, two, 500);
  ASSERT_EQ(once.samples(), again.samples());
  for (std::size_t k = 0; k < once.samples(); ++k) EXPECT_EQ(once.sample(k), again.sample(k));
  EXPECT_EQ(again.time_at(1), 0);
  EXPECT_EQ(again.time_at(2), again.time_at(3));
  EXPECT_EQ(again.time_at(5), again.duration());
  EXPECT_EQ(again.time_at(4), again.duration());
  EXPECT_EQ(Trajectory({{1, 2}}, Values{0}, two, 500).samples(), 1U);
  EXPECT_EQ(Trajectory({{1, 2}, {1, 2}}, {0, 0}, two, 500).samples(), 1U);
}

TEST(BlendedTrajectory, IsFasterThanFromRestToRest) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    Corners c = random_corners(seed);
    for (std::size_t j = 0; j < c.limits.jerk.size(); ++j)
      c.limits.jerk[j] = 20 * c.limits.acceleration[j];
    const Trajectory rests(c.path, c.limits, 1000),
        blended(c.path, Values(c.path.size(), 0.5), c.limits, 1000);
    // The jerk of motions from rest to rest is not limited: tiny ones are faster.
    if (rests.duration() > 0.05) {
      EXPECT_LE(blended.duration(), rests.duration()) << seed;
    }
  }
}

/// Two segments of an arm with six joints, and one; what of the time from rest to rest by quintics
/// it takes with jerks of 20 times the acceleration.
TEST(BlendedTrajectory, TakesThreeFifthsOfRestToRest) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> value(-1.7, 1.7);
  const SpeedLimits limits{Values(6, 2), Values(6, 5), Values(6, 100)};
  const auto point = [&] {
    Values q(6);
    for (double& x : q) x = value(random);
    return q;
  };
  std::vector<double> shares, larger;
  for (int k = 0; k < 40; ++k) {
    const robot::Path path{point(), point(), point()};
    const double rest = Trajectory(path, limits, 1000).duration();
    shares.push_back(Trajectory(path, {0, 0.5, 0}, limits, 1000).duration() / rest);
    larger.push_back(Trajectory(path, {0, kMostBlend, 0}, limits, 1000).duration() / rest);
  }
  std::ranges::sort(shares);
  std::ranges::sort(larger);
  EXPECT_LE(larger[20], 0.54);
  EXPECT_LE(shares[20], 0.6);
  EXPECT_LE(shares.back(), 0.7);
  // 0.5989 if speeds were not evened out where accelerations change too much.
  EXPECT_LE(std::accumulate(shares.begin(), shares.end(), 0.0) / 40, 0.5987);
}

/// Of one segment the fastest motion is known: a double-S.
TEST(BlendedTrajectory, OfOneSegmentIsADoubleS) {
  const auto time = [](double length, double v, double a, double j) {
    const Trajectory t({{0}, {length}}, Values{0, 0}, {{v}, {a}, {j}}, 1e6);
    return t.duration();
  };
  // All of it by jerks alone; to the full acceleration; to the full speed; with a small one.
  EXPECT_NEAR(time(1e-3, 10, 10, 1), 4 * std::cbrt(0.5e-3), 1e-3 * 4 * std::cbrt(0.5e-3));
  EXPECT_NEAR(time(1, 10, 4, 100), 0.04 + std::sqrt(0.04 * 0.04 + 1), 1e-3);
  EXPECT_NEAR(time(4, 2, 5, 100), 2 + 0.4 + 0.05, 1e-3);
  EXPECT_NEAR(time(4, 0.1, 5, 100), 40 + 2 * std::sqrt(0.1 / 100), 0.02);
}

TEST(BlendedTrajectory, WhatIsWrongIsRefused) {
  const SpeedLimits one{{1}, {1}, {1}};
  EXPECT_THROW(Trajectory({}, Values{}, one, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {1}}, {0}, one, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {1}, {2}}, {0, 0.96, 0}, one, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {1}, {2}}, {0, -0.1, 0}, one, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {1}, {2}}, {0, std::nan(""), 0}, one, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {1}}, {0, 0}, {{1}, {1}, {}}, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {1}}, {0, 0}, {{1}, {1}, {0}}, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {1e9}}, {0, 0}, one, 1000), Error);
}

/// Limits of what no joint reaches change nothing.
TEST(BlendedTrajectory, LimitsOfAnySize) {
  const robot::Path path{{0, 0}, {1, 0}, {1, 1}};
  const Values shares(3, 0.5);
  const auto time = [&](double velocity) {
    const SpeedLimits limits{Values(2, velocity), Values(2, 5), Values(2, 100)};
    return Trajectory(path, shares, limits, 1000).duration();
  };
  const double least = time(1e9);
  for (const double velocity : {1e31, 1e100, 1e200}) EXPECT_EQ(time(velocity), least) << velocity;
}

TEST(TrajectoryMessage, IsChosenByTheName) {
  for (const std::string name : {"t.json", "t.JSON", "a.csv.Json"})
    EXPECT_EQ(message_format(name), MessageFormat::Json) << name;
  for (const std::string name : {"t.yaml", "T.YML"})
    EXPECT_EQ(message_format(name), MessageFormat::Yaml) << name;
  for (const std::string name : {"t.csv", "json", "t.json.csv"})
    EXPECT_EQ(message_format(name), std::nullopt) << name;
}

TEST(TrajectoryMessage, SecondsFitInto32Bits) {
  const SpeedLimits limits{{1e-9}, {1}};
  robot::Robot robot;
  robot.variables.push_back({"j", {}, {}, {}});
  const Trajectory slow({{0}, {1.2}}, limits, 1e-3);  // 2.25e9 s
  EXPECT_THROW(to_joint_trajectory(slow, robot, MessageFormat::Json), Error);
}

TEST(TrajectoryMessage, IsReadAsTheSamplesWithTheirTimes) {
  robot::Robot robot;
  robot.variables = {{"a \"b\"", {}, {}}, {"c", {}, {}}};
  const Trajectory t({{0, 1e-7}, {1, 0}, {1, 1.0 / 3}}, {0, 0.5, 0}, {{1, 2}, {5, 5}, {100, 100}},
                     300);
  const std::string text = to_joint_trajectory(t, robot, MessageFormat::Json);
  const robot::NamedPath read = robot::parse_path_json(text, "t.json");
  ASSERT_EQ(read.waypoints.size(), t.samples());
  ASSERT_EQ(read.joints.size(), 3U);
  const auto time = static_cast<std::size_t>(
      std::find(read.joints.begin(), read.joints.end(), "time_from_start") - read.joints.begin());
  ASSERT_LT(time, 3U);
  for (std::size_t k = 0; k < t.samples(); ++k) {
    Values q = read.waypoints[k];
    EXPECT_NEAR(q[time], static_cast<double>(k) / 300, 0.6e-9);
    q.erase(q.begin() + static_cast<std::ptrdiff_t>(time));
    EXPECT_EQ(q, t.sample(k));
  }
  // YAML 1.1 takes 1e-07 for a word.
  const std::string yaml = to_joint_trajectory(t, robot, MessageFormat::Yaml);
  EXPECT_TRUE(
      yaml.starts_with("joint_names: [\"a \\\"b\\\"\", \"c\"]\npoints:\n"
                       "- positions: [0.0, 1.0e-07]\n"))
      << yaml.substr(0, 120);
  EXPECT_NE(yaml.find("\n  time_from_start: {sec: 0, nanosec: 3333333}\n"), std::string::npos);
}

/// What a controller makes of two samples: polynomials of degree 3, of values and velocities, and
/// of degree 5, of accelerations as well.
/// @param u  share of the time between them, which is `step`
std::pair<double, double> splines(const Instant& a, const Instant& b, std::size_t j, double u,
                                  double step) {
  const double p = a.q[j], d = b.q[j] - p, v = a.velocity[j] * step, w = b.velocity[j] * step,
               x = a.acceleration[j] * step * step, y = b.acceleration[j] * step * step;
  const double cubic = p + u * (v + u * (3 * d - 2 * v - w + u * (v + w - 2 * d)));
  const double c3 = 10 * d - 6 * v - 4 * w - 1.5 * x + 0.5 * y,
               c4 = -15 * d + 8 * v + 7 * w + 1.5 * x - y, c5 = 6 * d - 3 * (v + w) + 0.5 * (y - x);
  return {cubic, p + u * (v + u * (0.5 * x + u * (c3 + u * (c4 + u * c5))))};
}

/// Whether a segment of a path has two samples and what is between them in its box.
bool is_within_a_segment(const robot::Path& path, const std::vector<const Values*>& points) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    if (std::ranges::all_of(points, [&](const Values* q) {
          for (std::size_t j = 0; j < q->size(); ++j) {
            const auto [low, high] = std::minmax(path[i][j], path[i + 1][j]);
            if ((*q)[j] < low - 1e-13 || (*q)[j] > high + 1e-13) return false;
          }
          return true;
        }))
      return true;
  return false;
}

TEST(BlendedTrajectory, BetweenSamplesItIsOnASegmentOrWithinItsRoom) {
  std::size_t bent = 0, straight = 0;
  double nearest = 0, farthest_spline = 0;
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    const Corners c = random_corners(seed);
    for (const double rate : {7.0, 40.0, 300.0}) {
      const Trajectory t(c.path, c.shares, c.limits, rate);
      const Values room = room_between_samples(c.limits, rate);
      const auto bends = t.bends();
      std::size_t next = 0;
      for (std::size_t k = 0; k + 1 < t.samples(); ++k) {
        while (next < bends.size() && bends[next].second <= k) ++next;
        const bool is_bent = next < bends.size() && bends[next].first <= k;
        (is_bent ? bent : straight) += 1;
        const Instant a = t.instant(k), b = t.instant(k + 1);
        for (int part = 1; part < 8; ++part) {
          const double u = part / 8.0;
          const Values q = t.at((static_cast<double>(k) + u) / rate).q;
          if (!is_bent) {
            Values cubics, quintics;
            for (std::size_t j = 0; j < q.size(); ++j) {
              const auto [cubic, quintic] = splines(a, b, j, u, 1 / rate);
              cubics.push_back(cubic);
              quintics.push_back(quintic);
            }
            ASSERT_TRUE(is_within_a_segment(c.path, {&a.q, &b.q, &cubics, &quintics}))
                << seed << ", sample " << k << " at " << rate << " goes beyond a stop";
          }
          for (std::size_t j = 0; j < q.size(); ++j) {
            const double chord = a.q[j] + u * (b.q[j] - a.q[j]);
            const auto [cubic, quintic] = splines(a, b, j, u, 1 / rate);
            if (is_bent) {
              nearest = std::max(nearest, std::abs(q[j] - chord) / room[j]);
              for (const double x : {cubic, quintic}) {
                ASSERT_LE(std::abs(x - chord), room[j] + 1e-12) << seed << " " << k;
                farthest_spline = std::max(farthest_spline, std::abs(x - chord) / room[j]);
              }
              continue;
            }
            // All joints are at one share of the line between the samples.
            for (std::size_t i = 0; i < q.size(); ++i)
              ASSERT_NEAR((q[j] - a.q[j]) * (b.q[i] - a.q[i]), (q[i] - a.q[i]) * (b.q[j] - a.q[j]),
                          1e-13)
                  << seed << ", sample " << k << " at " << rate;
          }
        }
      }
    }
  }
  EXPECT_GT(bent, 3000U);
  EXPECT_GT(straight, 3000U);
  // The curve takes two thirds of the room at most, and nearly does.
  EXPECT_LE(nearest, 2.0 / 3 + 1e-6);
  EXPECT_GT(nearest, 0.6);
  EXPECT_GT(farthest_spline, 0.6);
}

/// The arm of three links goes round a plate with its last link drawn in. A full blend draws it in
/// less, and meets the plate.
class RoundAPlate : public ::testing::Test {
 protected:
  RoundAPlate() {
    files_.put(
        "plate.glb",
        test::set_of({test::box_mesh({-0.25, -0x1p-13, -0.5}, {0.25, 0x1p-13, 0.5})}, "outer", 0));
    world_ = files_.world(files_.scene(
        "\"objects\": [{\"name\": \"plate\", \"pose\": {\"position\": [2.7, 0, 0]}, \"outer\": " +
        files_.ref("plate.glb") + "}]"));
  }
  [[nodiscard]] world::MotionAnswer check(const world::Checker& checker,
                                          const Trajectory& t) const {
    robot::Path samples;
    for (std::size_t k = 0; k < t.samples(); ++k) samples.push_back(t.sample(k));
    return check_motion(checker, initial_state(world_), 0, samples, {.resolution = 1e-8});
  }
  test::SceneFiles files_;
  world::World world_;
  const robot::Path path_{{-0.6, 0, 0}, {-0.448, 0, 1.5}, {0.5, 0, 0}};
};

TEST_F(RoundAPlate, ABlendThatMeetsItIsMadeSmaller) {
  using Outcome = world::MotionAnswer::Outcome;
  const world::Checker checker(world_);
  const world::WorldState state = initial_state(world_);
  TrajectoryOptions options;
  options.blend = 0.5;
  const SampledPath made = sample_path({checker, state, 0}, path_, options, 1e-5);
  ASSERT_EQ(made.blends.size(), 3U);
  EXPECT_GT(made.blends[1], 0);
  EXPECT_LT(made.blends[1], 0.5);
  EXPECT_EQ(check(checker, made.trajectory).outcome, Outcome::Free);
  for (const double between : made.between_samples) EXPECT_EQ(between, 0.1875 * 5.0 / 1e6);
  // The one that was asked for is in contact.
  const world::MotionAnswer full =
      check(checker, Trajectory(path_, {0, 0.5, 0}, made.limits, options.rate));
  EXPECT_EQ(full.outcome, Outcome::Contact);
  EXPECT_TRUE(full.meets);
  // Smaller ones take more time; the same is made again.
  options.blend = made.blends[1];
  EXPECT_EQ(sample_path({checker, state, 0}, path_, options, 1e-5).csv, made.csv);
  options.blend = 0;
  EXPECT_GT(sample_path({checker, state, 0}, path_, options, 1e-5).trajectory.duration(),
            made.trajectory.duration());
}

/// A cube of 2 mm that slides in a plane, and a needle beside its way round a corner.
world::World gantry_at(const geom::Vec3& needle) {
  test::SceneFiles files;
  const std::string urdf = R"(<robot name="gantry"><link name="base"/><link name="bridge"/>
    <link name="tool"><collision><geometry><box size="0.002 0.002 0.002"/></geometry></collision></link>
    <joint name="x" type="prismatic"><parent link="base"/><child link="bridge"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="2" effort="1" velocity="1"/></joint>
    <joint name="y" type="prismatic"><parent link="bridge"/><child link="tool"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="1" velocity="1"/></joint></robot>)";
  files.files["gantry.urdf"] = {urdf.begin(), urdf.end()};
  const auto cube = [](double x) { return test::box_mesh({-x, -x, -x}, {x, x, x}); };
  files.put("tool.glb", test::set_of({cube(0x1p-10)}, "outer", 0, "tool"));
  files.put("needle.glb", test::set_of({cube(0x1p-14)}, "outer", 0));
  std::ostringstream text;
  text.precision(17);
  text << R"({"kaboum_scene": 1, "unit": "m", "robots": [{"name": "gantry", "urdf": )"
       << files.ref("gantry.urdf") << R"(, "links": [{"link": "tool", "outer": )"
       << files.ref("tool.glb") << R"(}]}], "objects": [{"name": "needle", "pose": {"position": [)"
       << needle.x() << ", " << needle.y() << R"(, 0]}, "outer": )" << files.ref("needle.glb")
       << "}]}";
  return files.world(text.str());
}

TEST(BlendedTrajectory, IsFreeBetweenItsSamples) {
  const robot::Path path{{0, 0}, {1, 0}, {1, 1}};
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> part(0.2, 0.8), beside(-0.004, 0.004);
  std::size_t whole = 0, smaller = 0, met = 0;
  for (int k = 0; k < 150; ++k) {
    TrajectoryOptions options;
    options.blend = 0.5;
    options.rate = 6 + k % 4 * 3;
    const Trajectory full(path, {0, 0.5, 0}, {{1, 1}, {5, 5}, {100, 100}}, options.rate);
    const Values at = full.at(full.duration() * part(random)).q;
    const world::World world = gantry_at({at[0] + beside(random), at[1] + beside(random), 0});
    const world::Checker checker(world);
    world::WorldState state = initial_state(world);
    world::Scratch scratch;
    const auto meets = [&](const Values& q) {
      state.q[0] = q;
      return checker.find_contact(state, scratch).has_value();
    };
    const auto meets_between = [&](const Trajectory& t) {
      for (std::size_t i = 0; i + 1 < t.samples(); ++i) {
        const Instant a = t.instant(i), b = t.instant(i + 1);
        const bool bent = std::ranges::any_of(
            t.bends(), [&](const auto& bend) { return i >= bend.first && i < bend.second; });
        for (int n = 0; n < 200; ++n) {
          const double u = n / 200.0;
          Values cubic(2), quintic(2);
          for (std::size_t j = 0; j < 2; ++j)
            std::tie(cubic[j], quintic[j]) = splines(a, b, j, u, 1 / t.rate());
          if (meets(t.at((static_cast<double>(i) + u) / t.rate()).q)) return true;
          // Elsewhere they are on the path, and may be a little ahead or behind.
          if (bent && (meets(cubic) || meets(quintic))) return true;
        }
      }
      return false;
    };
    if (check_motion(checker, state, 0, path, {}).outcome != world::MotionAnswer::Outcome::Free)
      continue;
    const SampledPath made = sample_path({checker, state, 0}, path, options, 1e-5);
    (made.blends[1] == 0.5 ? whole : smaller) += 1;
    EXPECT_FALSE(meets_between(made.trajectory)) << k;
    // Of trajectories of which the straight lines between samples are free, some meet it.
    robot::Path samples;
    for (std::size_t i = 0; i < full.samples(); ++i) samples.push_back(full.sample(i));
    state.q[0] = path[0];
    if (check_motion(checker, state, 0, samples, {}).outcome == world::MotionAnswer::Outcome::Free)
      met += meets_between(full) ? 1 : 0;
  }
  EXPECT_GT(whole, 5U);
  EXPECT_GT(smaller, 20U);
  EXPECT_GT(met, 10U);
}

TEST_F(RoundAPlate, OptionsThatContradictAreRefused) {
  const world::Checker checker(world_);
  const world::WorldState state = initial_state(world_);
  for (const TrajectoryOptions& wrong :
       {TrajectoryOptions{.time_optimal = true, .blend = 0.5}, TrajectoryOptions{.blend = 0.96},
        TrajectoryOptions{.jerks = {{"", 5.0}}},
        TrajectoryOptions{.blend = 0.5, .jerks = {{"", 0}}}})
    EXPECT_THROW(sample_path({checker, state, 0}, path_, wrong, 1e-5), Error);
}

TEST(BlendedTrajectory, AmongRandomObjectsIsFreeOfTheExactMeshesAt1kHz) {
  std::size_t corners = 0, smaller = 0, met = 0;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const test::RandomScene scene = test::random_scene(seed, 14);
    const world::Checker checker(scene.world);
    const world::WorldState state = initial_state(scene.world);
    std::mt19937_64 random(seed);
    for (int query = 0; query < 3; ++query) {
      std::vector<Values> ends(2);
      world::Scratch scratch;
      for (Values& end : ends) {
        world::WorldState at = state;
        do at.q[0] = test::random_values(scene.world.robots[0].kinematics, random);
        while (checker.find_contact(at, scratch));
        end = at.q[0];
      }
      PathOptions search;
      search.most_work = 0.2;
      const PathAnswer answer = find_path(checker, state, 0, ends[0], {{ends[1]}}, search);
      if (answer.outcome != PathAnswer::Outcome::Found || answer.straight) continue;
      TrajectoryOptions options;
      options.blend = 0.5;
      const SampledPath made = sample_path({checker, state, 0}, answer.path, options, 1e-5);
      const auto contact = [&](const Trajectory& t) {
        for (std::size_t k = 0; k < t.samples(); ++k)
          if (scene.exact.find_contact(t.sample(k))) return true;
        return false;
      };
      EXPECT_FALSE(contact(made.trajectory)) << "seed " << seed << ", query " << query;
      Values full(answer.path.size(), 0.5);
      corners += full.size() - 2;
      for (std::size_t i = 1; i + 1 < full.size(); ++i) smaller += made.blends[i] < 0.5 ? 1 : 0;
      met += contact(Trajectory(answer.path, full, made.limits, options.rate)) ? 1 : 0;
    }
  }
  EXPECT_GT(corners, 10U);
  EXPECT_GT(smaller, 1U);
  EXPECT_GT(met, 0U) << "full blends are free as well: nothing is tested";
}

}  // namespace
}  // namespace kaboum::motion
