// verify_distance against known distances and dense samples.
#include <kaboum/base/error.h>
#include <kaboum/verify/distance.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pairs.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test
using verify::Answer;

/// Distance of a point to a triangle: over its plane, else to its sides.
double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_side = [&](const Vec3& s, const Vec3& e) {
    const Vec3 d = e - s;
    const double square = d.squaredNorm();
    const double t = square > 0 ? std::clamp((p - s).dot(d) / square, 0.0, 1.0) : 0.0;
    return (p - s - t * d).norm();
  };
  double best = std::min({to_side(a, b), to_side(b, c), to_side(c, a)});
  const Vec3 n = (b - a).cross(c - a);
  if (n.norm() > 0) {
    const bool over = n.cross(b - a).dot(p - a) >= 0 && n.cross(c - b).dot(p - b) >= 0 &&
                      n.cross(a - c).dot(p - c) >= 0;
    if (over) best = std::min(best, std::abs((p - a).dot(n.normalized())));
  }
  return best;
}

double to_mesh(const Vec3& p, const Mesh& mesh) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles) {
    best = std::min(best,
                    to_triangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  return best;
}

struct Range {
  double low = 0, high = 0;
};

/// Bounds of the one-sided distance: the greatest of a grid of points on every triangle, and the
/// same plus what can be missed between them.
Range sampled(const Mesh& from, const Mesh& to, int n, bool to_solid) {
  Range range;
  for (const auto& t : from.triangles) {
    const Vec3 &a = from.vertices[t[0]], &b = from.vertices[t[1]], &c = from.vertices[t[2]];
    const double cell = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()}) / n;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vec3 p = a + (b - a) * i / n + (c - a) * j / n;
        double d = to_mesh(p, to);
        if (to_solid) {
          const auto w = winding_number_slow(to, p);
          if (!w || *w >= 1) d = 0;
        }
        range.low = std::max(range.low, d);
        range.high = std::max(range.high, d + cell);
      }
    }
  }
  return range;
}

Answer claim(const Mesh& from, const Mesh& to, double epsilon, bool to_solid = false) {
  verify::DistanceClaimOptions options;
  options.to_solid = to_solid;
  const auto result = verify::verify_distance(from, to, epsilon, options);
  if (result.answer == Answer::Refuted) {
    EXPECT_GT(result.largest, epsilon);
    EXPECT_FALSE(result.reason.empty());
    // The place shows it.
    EXPECT_GE(to_mesh(result.at, to), result.largest * (1 - 1e-9));
    if (to_solid) {
      EXPECT_LE(winding_number_slow(to, result.at).value_or(1), 0);
    }
    EXPECT_LE(to_mesh(result.at, from), 1e-9 * (1 + result.at.norm()));
  } else {
    EXPECT_LE(result.largest, epsilon);
  }
  EXPECT_GE(result.pieces, from.triangles.size());
  return result.answer;
}

/// `distance` is the exact one-sided distance.
void expect_distance(const Mesh& from, const Mesh& to, double distance, bool to_solid,
                     const char* what) {
  for (const double off : {1e-1, 1e-3, 1e-6, 1e-9}) {
    EXPECT_EQ(claim(from, to, distance * (1 + off), to_solid), Answer::Verified) << what << off;
    EXPECT_EQ(claim(from, to, distance * (1 - off), to_solid), Answer::Refuted) << what << off;
  }
  // At the distance itself nothing wrong may be said.
  EXPECT_NE(claim(from, to, std::nextafter(distance, 0), to_solid), Answer::Verified) << what;
  EXPECT_NE(claim(from, to, std::nextafter(distance, 9e99), to_solid), Answer::Refuted) << what;
}

TEST(Distance, KnownOnes) {
  const Mesh small = translated(box({1, 1, 1}, 2), {1, 1, 1}), large = box({3, 3, 3}, 3);
  expect_distance(large, small, std::sqrt(3.0), false, "corner to corner ");
  expect_distance(small, large, 1, false, "face to face ");
  expect_distance(large, small, std::sqrt(3.0), true, "corner to solid ");
  const Mesh beside = translated(box({1, 1, 1}, 1), {5, 0, 0});
  expect_distance(beside, box({1, 1, 1}, 1), 5, false, "beside ");
  expect_distance(beside, box({1, 1, 1}, 1), 5, true, "beside, solid ");
  const Mesh plate = grid(3, [](double, double) { return 0.0; });
  expect_distance(translated(plate, {0, 0, 0.5}), plate, 0.5, false, "parallel plates ");
  expect_distance(translated(scaled(plate, {4, 4, 1}), {0, 0, 1}), plate, std::sqrt(19.0), false,
                  "larger plate ");
}

TEST(Distance, InTheMiddleOfATriangle) {
  // The farthest point is no corner: one large triangle over two at its corners.
  const Mesh bar{{{-1, 0, 0}, {1, 0, 0}, {0, 1e-3, 0}}, {{0, 1, 2}}};
  const Mesh ends = merged({translated(box({0.5, 2, 2}, 1), {-1.25, -1, -1}),
                            translated(box({0.5, 2, 2}, 1), {0.75, -1, -1})});
  expect_distance(bar, ends, 0.75, true, "between two solids ");
}

TEST(Distance, InsideTheSolidIsNoDistance) {
  const Mesh small = translated(box({1, 1, 1}, 2), {1, 1, 1}), large = box({3, 3, 3}, 3);
  EXPECT_EQ(claim(small, large, 1e-6, true), Answer::Verified);
  EXPECT_EQ(claim(small, large, 1e-6, false), Answer::Refuted);
  // A cavity is no part of the solid: the middle of it is half its width away.
  const Mesh hollow = merged({large, flipped(small)});
  const Mesh speck = translated(box(Vec3::Constant(1e-3), 1), Vec3::Constant(1.5 - 0.5e-3));
  EXPECT_EQ(claim(speck, hollow, 0.51, true), Answer::Verified);
  EXPECT_EQ(claim(speck, hollow, 0.49, true), Answer::Refuted);
  EXPECT_EQ(claim(speck, merged({large, small}), 1e-6, true), Answer::Verified);  // w = 2
}

TEST(Distance, TouchingSurfaces) {
  const Mesh ball = icosphere(2);
  for (const double epsilon : {1.0, 1e-3, 1e-9})
    EXPECT_EQ(claim(ball, ball, epsilon), Answer::Verified);
  const Mesh coarse = box({1, 1, 1}, 2), fine = box({1, 1, 1}, 3);
  for (const double epsilon : {1.0, 1e-2})
    EXPECT_EQ(claim(coarse, fine, epsilon), Answer::Verified);
  // Side by side: the far face is at distance 1 as a whole.
  expect_distance(coarse, translated(fine, {1, 0, 0}), 1, true, "sharing a face ");
  // Below the rounding of the coordinates nothing is certain, and nothing wrong is said.
  EXPECT_NE(claim(ball, ball, 1e-20), Answer::Refuted);
}

TEST(Distance, AgainstDenseSamples) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Random random(seed);
    const auto odd = [&] { return std::ldexp(static_cast<double>(random() >> 11U), -53); };
    const Mesh a = noisy(icosphere(1), 0.3, static_cast<std::uint32_t>(seed));
    const Mesh b = translated(
        rotated(noisy(icosphere(1), 0.2, static_cast<std::uint32_t>(seed + 50)), 6 * odd()),
        {0.3 * odd(), odd(), 0.2 * odd()});
    for (const bool to_solid : {false, true}) {
      const Range range = sampled(a, b, to_solid ? 6 : 16, to_solid);
      EXPECT_EQ(claim(a, b, range.high, to_solid), Answer::Verified) << seed;
      EXPECT_EQ(claim(a, b, range.low * (1 - 1e-9), to_solid), Answer::Refuted) << seed;
      // The same wherever the meshes are.
      const Vec3 far(1000, -2000, 3000);
      EXPECT_EQ(claim(translated(a, far), translated(b, far), range.high * 1.000001, to_solid),
                Answer::Verified);
    }
  }
}

TEST(Distance, ScalesAndThinTriangles) {
  for (const double s : {1e-100, 1e-30, 1e30, 1e100}) {
    const Mesh small = scaled(translated(box({1, 1, 1}, 2), {1, 1, 1}), Vec3::Constant(s));
    const Mesh large = scaled(box({3, 3, 3}, 2), Vec3::Constant(s));
    EXPECT_EQ(claim(large, small, 1.7321 * s), Answer::Verified) << s;
    EXPECT_EQ(claim(large, small, 1.7320 * s), Answer::Refuted) << s;
  }
  const Mesh rod = cylinder(60, 40, 1, 0);
  EXPECT_EQ(claim(rotated(rod, 0.4), rotated(rod, 0.4), 1e-6), Answer::Verified);
  EXPECT_EQ(claim(rotated(scaled(rod, {1.01, 1.01, 1}), 0.4), rotated(rod, 0.4), 0.0101),
            Answer::Verified);
  EXPECT_EQ(claim(rotated(scaled(rod, {1.01, 1.01, 1}), 0.4), rotated(rod, 0.4), 0.0099),
            Answer::Refuted);
}

TEST(Distance, LimitLeavesItUndecided) {
  verify::DistanceClaimOptions options;
  options.max_pieces = 1;
  const Mesh coarse = box({1, 1, 1}, 2), fine = box({1, 1, 1}, 3);
  EXPECT_EQ(verify::verify_distance(coarse, fine, 0.1, options).answer, Answer::Undecided);
  EXPECT_EQ(verify::verify_distance(coarse, fine, 0.1).answer, Answer::Verified);
  EXPECT_THROW(verify::verify_distance(Mesh{{{0, 0, 0}}, {{0, 1, 2}}}, fine, 1), Error);
}

}  // namespace
