// Radii that a parallel body allows, against boxes whose distances are known, and against points
// whose distances are measured.
#include "parallel_body.h"

#include <gtest/gtest.h>
#include <kaboum/base/random.h>

#include <cmath>

#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using geom::Vec3;
using kaboum::test::box;
using kaboum::test::merged;
using kaboum::test::translated;

/// A mesh and what a parallel body refers to.
struct Solid {
  explicit Solid(Mesh m) : mesh(std::move(m)), surface(mesh), winding(mesh) {}
  Mesh mesh;
  geom::DistanceQuery surface;
  geom::WindingNumber winding;
};

TEST(ParallelBody, RadiiInABoxAreThoseOfTheNearestFace) {
  const Solid solid(box({2, 3, 4}, 3));
  const ParallelBody body(solid.surface, solid.winding, 0.5, 0.1);
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Vec3 c(random.between(0.3, 1.7), random.between(0.3, 2.7), random.between(0.3, 3.7));
    const double depth = std::min(c.minCoeff(), (Vec3(2, 3, 4) - c).minCoeff());
    EXPECT_LE(body.radius_about(c), depth + 0.5);
    EXPECT_GE(body.radius_about(c), depth + 0.5 * (1 - 1e-9));  // the ball at the nearest face
    EXPECT_LE(body.refined_radius_about(c, 0.02), depth + 0.5);
  }
  EXPECT_EQ(body.radius_about({-0.6, 1, 1}), 0);
  EXPECT_GT(body.radius_about({-0.3, 1, 1}), 0.19);
}

// Walls inside a solid bound nothing, and cavities that are less wide than twice the distance are
// within it.
TEST(ParallelBody, WallsAndCracksInsideDoNotCount) {
  const Solid solid(merged({box({1, 1, 1}, 2), translated(box({1, 1, 1}, 2), {0.5, 0, 0}),
                            translated(box({1, 1, 1}, 2), {1.6, 0, 0})}));
  const ParallelBody body(solid.surface, solid.winding, 0.2, 0.1);
  for (const double x : {0.5, 0.6, 0.99, 1.0, 1.5, 1.55, 1.6, 1.61}) {
    // At the crack the boundary dips to half its width beside the edges.
    const double most = x < 1.2 ? 0.7 : 0.5 + std::sqrt(0.2 * 0.2 - 0.05 * 0.05);
    EXPECT_LE(body.radius_about({x, 0.5, 0.5}), 0.7) << x;
    // Caps lose half the square of their share; at the dip, where two edges are as near, a part of
    // their size.
    const double coarse = x < 1.2 ? 0.2 * 0.5 * 0.1 * 0.1 : 0.2 * 0.1;
    const double fine = x < 1.2 ? 0.2 * 0.5 * 0.02 * 0.02 : 0.2 * 0.02;
    EXPECT_GE(body.radius_about({x, 0.5, 0.5}), most - coarse - 1e-9) << x;
    EXPECT_GE(body.refined_radius_about({x, 0.5, 0.5}, 0.02), most - fine - 1e-9) << x;
  }
}

// What a radius ends at is as far away as it says, and no point of the body but for the caps' size.
TEST(ParallelBody, LimitsAreBeyondTheBody) {
  const Solid solid(
      merged({kaboum::test::torus(1, 0.3, 40, 20), translated(box({0.5, 0.7, 1}, 2), {1, 0, 0})}));
  const double distance = 0.1, share = 0.1;
  const ParallelBody body(solid.surface, solid.winding, distance, share);
  Random random(7);
  int known = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 c(random.between(-1.4, 1.6), random.between(-1.4, 1.4), random.between(-0.4, 1.1));
    const ParallelBody::Room room = body.room_about(c);
    EXPECT_EQ(room.radius, body.radius_about(c));
    if (!(room.radius > 0)) {
      EXPECT_FALSE(room.limit);
      continue;
    }
    if (!room.limit) continue;
    ++known;
    EXPECT_NEAR((*room.limit - c).norm(), room.radius, 0.02 * distance);
    EXPECT_GT(body.signed_distance(*room.limit).upper, distance * (1 - 2 * share)) << i;
  }
  EXPECT_GT(known, 40);
}

// No point of a ball is farther; of one that is a little larger, some are.
TEST(ParallelBody, BallsAreAsLargeAsTheyMayBe) {
  const Solid solid(
      merged({kaboum::test::torus(1, 0.3, 40, 20), translated(box({0.5, 0.7, 1}, 2), {1, 0, 0})}));
  const double distance = 0.1;
  const ParallelBody body(solid.surface, solid.winding, distance, 0.1);
  Random random(5);
  const auto direction = [&] {
    for (;;) {
      const Vec3 d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
      if (d.norm() > 0.1 && d.norm() <= 1) return Vec3(d.normalized());
    }
  };
  int tight = 0, balls = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 c(random.between(-1.4, 1.6), random.between(-1.4, 1.4), random.between(-0.4, 1.1));
    const double coarse = body.radius_about(c), fine = body.refined_radius_about(c, 0.02);
    EXPECT_LE(coarse, fine);
    if (!(coarse > 0.02)) continue;
    ++balls;
    bool beyond = false;
    for (int k = 0; k < 6000; ++k) {
      const Vec3 d = direction();
      const double share = k % 4 == 0 ? random.between(0, 1) : 1;
      EXPECT_LE(body.signed_distance(c + share * fine * d).lower, distance);
      beyond = beyond || body.signed_distance(c + (1.1 * fine + 0.005) * d).upper > distance;
    }
    tight += beyond ? 1 : 0;
  }
  EXPECT_GT(balls, 15);
  EXPECT_EQ(tight, balls);
}

TEST(ParallelBody, AnySizeAndPlace) {
  for (const double size : {1e-6, 1.0, 1e6}) {
    const Vec3 at(10 * size, -20 * size, 3 * size);
    const Solid solid(translated(box(size * Vec3(2, 3, 4), 1), at));
    const ParallelBody body(solid.surface, solid.winding, 0.5 * size, 0.1);
    const double radius = body.radius_about(at + size * Vec3(1, 1, 1));
    EXPECT_LE(radius, 1.5 * size * (1 + 1e-9));
    EXPECT_GE(radius, 1.5 * size * (1 - 1e-8));
  }
}

}  // namespace
}  // namespace kaboum::bcd
