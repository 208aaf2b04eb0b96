// Paths in time: on the path, within the limits, twice continuously differentiable.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/motion/trajectory.h>

#include <cmath>
#include <limits>
#include <random>

namespace kaboum::motion {
namespace {

using Values = std::vector<double>;

struct Case {
  robot::Path path;
  SpeedLimits limits;
  double rate = 1000;
};

Case random_case(std::uint32_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-3, 3), limit(0.1, 8);
  Case out;
  const std::size_t joints = 1 + random() % 6, waypoints = 1 + random() % 5;
  for (std::size_t i = 0; i < waypoints; ++i) {
    Values q;
    for (std::size_t j = 0; j < joints; ++j)
      q.push_back(random() % 5 == 0 && i > 0 ? out.path[i - 1][j] : value(random));
    out.path.push_back(q);
  }
  for (std::size_t j = 0; j < joints; ++j) {
    out.limits.velocity.push_back(limit(random));
    out.limits.acceleration.push_back(limit(random));
  }
  out.rate = random() % 2 == 0 ? 1000 : 62.5;
  return out;
}

/// How far q is from the segment from a to b, in the largest coordinate.
double distance_to(const Values& q, const Values& a, const Values& b) {
  double along = 0, length = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    along += (q[i] - a[i]) * (b[i] - a[i]);
    length += (b[i] - a[i]) * (b[i] - a[i]);
  }
  const double share = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
  double far = 0;
  for (std::size_t i = 0; i < q.size(); ++i)
    far = std::max(far, std::abs(q[i] - a[i] - share * (b[i] - a[i])));
  return far;
}

TEST(Trajectory, StaysOnThePathInOrderWithinTheLimits) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const Case c = random_case(seed);
    const Trajectory t(c.path, c.limits, c.rate);
    std::size_t segment = 0;
    EXPECT_EQ(t.sample(0), c.path.front());
    EXPECT_EQ(t.sample(t.samples() - 1), c.path.back());
    double fastest = 0;
    for (std::size_t k = 0; k < t.samples(); ++k) {
      const Instant now = t.at(static_cast<double>(k) / c.rate);
      const Values q = t.sample(k);
      for (std::size_t j = 0; j < q.size(); ++j) {
        EXPECT_NEAR(now.q[j], q[j], 1e-9);
        EXPECT_LE(std::abs(now.velocity[j]), c.limits.velocity[j] * (1 + 1e-12));
        EXPECT_LE(std::abs(now.acceleration[j]), c.limits.acceleration[j] * (1 + 1e-12));
        fastest = std::max({fastest, std::abs(now.velocity[j]) / c.limits.velocity[j],
                            std::abs(now.acceleration[j]) / c.limits.acceleration[j]});
      }
      // Waypoints are passed in their order; straight lines between samples stay on one segment.
      while (segment + 2 < c.path.size() &&
             distance_to(q, c.path[segment], c.path[segment + 1]) > 1e-12)
        ++segment;
      if (c.path.size() > 1) {
        ASSERT_LE(distance_to(q, c.path[segment], c.path[segment + 1]), 1e-12) << seed << " " << k;
      }
    }
    if (c.rate == 1000 && t.samples() > 500) {
      EXPECT_GT(fastest, 0.95) << "needlessly slow";
    }
  }
}

TEST(Trajectory, WaypointsAreSamples) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const Case c = random_case(seed);
    const Trajectory t(c.path, c.limits, c.rate);
    std::size_t next = 0;
    for (std::size_t k = 0; k < t.samples() && next < c.path.size(); ++k)
      while (next < c.path.size() && t.sample(k) == c.path[next]) ++next;
    EXPECT_EQ(next, c.path.size()) << seed;
  }
}

TEST(Trajectory, DerivativesAreThoseOfTheValuesAndContinuous) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const Case c = random_case(seed);
    const Trajectory t(c.path, c.limits, c.rate);
    const double h = 1e-5;
    // The jerk is at most 60 |Δ| / T³; T² ≥ 5.77 |Δ| / a and T ≥ 1.875 |Δ| / v give a bound.
    for (double time = 2 * h; time + 2 * h < t.duration(); time += 0.0137) {
      const Instant before = t.at(time - h), now = t.at(time), after = t.at(time + h);
      for (std::size_t j = 0; j < now.q.size(); ++j) {
        EXPECT_NEAR((after.q[j] - before.q[j]) / (2 * h), now.velocity[j], 1e-5);
        EXPECT_NEAR((after.velocity[j] - before.velocity[j]) / (2 * h), now.acceleration[j], 2e-2);
      }
    }
    // At waypoints all is at rest, from both sides.
    for (std::size_t k = 0; k < t.samples(); ++k) {
      if (std::find(c.path.begin(), c.path.end(), t.sample(k)) == c.path.end()) continue;
      const double at = static_cast<double>(k) / c.rate;
      for (const double time : {std::max(0.0, at - 1e-9), std::min(t.duration(), at + 1e-9)})
        for (std::size_t j = 0; j < c.path[0].size(); ++j) {
          EXPECT_NEAR(t.at(time).velocity[j], 0, 1e-6);
          EXPECT_NEAR(t.at(time).acceleration[j], 0, 1e-3);
        }
    }
  }
}

TEST(Trajectory, TrapezoidsAreTheFastest) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const Case c = random_case(seed);
    const Trajectory t(c.path, c.limits, c.rate, Profile::Trapezoid),
        quintic(c.path, c.limits, c.rate);
    EXPECT_LE(t.samples(), quintic.samples());
    // The least time of each segment by itself: at full acceleration until half the way, or until
    // some joint is as fast as it may be.
    double least = 0;
    for (std::size_t i = 0; i + 1 < c.path.size(); ++i) {
      double fastest = std::numeric_limits<double>::infinity(), most = fastest;
      for (std::size_t j = 0; j < c.path[i].size(); ++j) {
        const double change = std::abs(c.path[i + 1][j] - c.path[i][j]);
        if (change == 0) continue;
        fastest = std::min(fastest, c.limits.velocity[j] / change);
        most = std::min(most, c.limits.acceleration[j] / change);
      }
      if (std::isinf(most)) continue;
      const double reached = std::min(fastest, std::sqrt(most));
      least += reached / most + 1 / reached;
    }
    EXPECT_GE(t.duration(), least * (1 - 1e-12));
    EXPECT_LE(t.duration(), least * (1 + 1e-8) + static_cast<double>(c.path.size()) / c.rate);
    Values before = t.sample(0), previous = before;
    for (std::size_t k = 0; k < t.samples(); ++k) {
      const Instant now = t.at(static_cast<double>(k) / c.rate);
      const Values q = t.sample(k);
      for (std::size_t j = 0; j < q.size(); ++j) {
        EXPECT_NEAR(now.q[j], q[j], 1e-9);
        EXPECT_LE(std::abs(now.velocity[j]), c.limits.velocity[j] * (1 + 1e-9));
        EXPECT_LE(std::abs(now.acceleration[j]), c.limits.acceleration[j] * (1 + 1e-9));
        // Differences of samples tell the same, and that velocities do not jump.
        EXPECT_LE(std::abs(q[j] - before[j]) * c.rate, c.limits.velocity[j] * (1 + 1e-6));
        if (k > 1) {
          EXPECT_LE(std::abs(q[j] - 2 * before[j] + previous[j]) * c.rate * c.rate,
                    c.limits.acceleration[j] * (1 + 1e-6) + 1e-6);
        }
      }
      previous = before;
      before = q;
    }
  }
}

/// Of a controller that goes by polynomials of degree 5 through the samples.
Values quintic_between(const Instant& a, const Instant& b, double u, double h) {
  Values out;
  for (std::size_t j = 0; j < a.q.size(); ++j) {
    const double d = b.q[j] - a.q[j], v = a.velocity[j] * h, w = b.velocity[j] * h,
                 x = a.acceleration[j] * h * h, y = b.acceleration[j] * h * h;
    const double c3 = 10 * d - 6 * v - 4 * w - 1.5 * x + 0.5 * y,
                 c4 = -15 * d + 8 * v + 7 * w + 1.5 * x - y,
                 c5 = 6 * d - 3 * (v + w) + 0.5 * (y - x);
    out.push_back(a.q[j] + u * (v + u * (0.5 * x + u * (c3 + u * (c4 + u * c5)))));
  }
  return out;
}

TEST(Trajectory, PolynomialsThroughSamplesStayOnTheSegments) {
  std::vector<Case> cases{{{{0, 0}, {1, 0}, {1, 1}}, {{2, 2}, {5, 5}}}};
  for (std::uint32_t seed = 0; seed < 100; ++seed) cases.push_back(random_case(seed));
  for (const Case& c : cases)
    for (const Profile profile : {Profile::Quintic, Profile::Trapezoid})
      for (const double rate : {1.0, 10.0, 100.0}) {
        const Trajectory t(c.path, c.limits, rate, profile);
        std::size_t stop = 0;
        for (std::size_t k = 0; k + 1 < t.samples(); ++k) {
          const auto time = static_cast<double>(k) / rate;
          while (stop + 2 < c.path.size() && t.time_at(stop + 1) <= time) ++stop;
          for (int part = 0; part <= 10; ++part)
            ASSERT_LE(
                distance_to(quintic_between(t.instant(k), t.instant(k + 1), part / 10.0, 1 / rate),
                            c.path[stop], c.path[stop + 1]),
                1e-12)
                << "sample " << k << " of " << t.samples() << " at " << rate;
        }
        for (std::size_t i = 0; i < c.path.size(); ++i) {
          const Instant at = t.instant(static_cast<std::size_t>(std::lround(t.time_at(i) * rate)));
          EXPECT_EQ(at.velocity, Values(at.q.size(), 0));
          EXPECT_EQ(at.acceleration, Values(at.q.size(), 0));
        }
      }
}

TEST(Trajectory, IsReadBackAsItIs) {
  robot::Robot robot;
  robot.variables = {{"a", {}, {}}, {"b", {}, {}}};
  const Trajectory t({{0.1, 1.0 / 3}, {2, -0.7}, {2, 5}}, {{1, 2}, {3, 4}}, 125);
  const robot::NamedPath samples = robot::parse_path_csv(to_csv(t, robot), "t.csv");
  EXPECT_EQ(samples.joints, (std::vector<std::string>{"time_from_start", "a", "b"}));
  ASSERT_EQ(samples.waypoints.size(), t.samples());
  for (std::size_t k = 0; k < t.samples(); ++k) {
    EXPECT_EQ(samples.waypoints[k][0], static_cast<double>(k) / 125);
    EXPECT_EQ(Values(samples.waypoints[k].begin() + 1, samples.waypoints[k].end()), t.sample(k));
  }
  const robot::NamedPath path = robot::parse_path_csv(to_csv(t.path(), robot), "p.csv");
  EXPECT_EQ(path.waypoints, t.path());
}

TEST(Trajectory, WhatIsWrongIsRefused) {
  const SpeedLimits one{{1}, {1}};
  EXPECT_THROW(Trajectory({}, one, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {1, 2}}, one, 1000), Error);
  EXPECT_THROW(Trajectory({{0}, {std::nan("")}}, one, 1000), Error);
  EXPECT_THROW(Trajectory({{0}}, {{0}, {1}}, 1000), Error);
  EXPECT_THROW(Trajectory({{0}}, {{1}, {}}, 1000), Error);
  EXPECT_THROW(Trajectory({{0}}, one, 0), Error);
  EXPECT_THROW(Trajectory({{0}, {1e9}}, one, 1000), Error);
  EXPECT_EQ(Trajectory({{0}}, one, 1000).samples(), 1U);
  EXPECT_EQ(Trajectory({{0}, {0}}, one, 1000).samples(), 1U);
}

}  // namespace
}  // namespace kaboum::motion
