// The quick search for the nearest triangle, against all of them; what the original allows of
// planes under a star.
#include "closest_triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/families.h"
#include "support/shapes.h"
#include "support_planes.h"

namespace kaboum::bmesh {
namespace {

double nearest_of_all(const geom::Mesh& mesh, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const geom::Triangle& t : mesh.triangles)
    best = std::min(
        best, squared_distance(p, {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}));
  return best;
}

TEST(ClosestTriangle, FindsTheNearestOfAll) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-0.3, 1.3);
  for (const auto& f : test::closed_families()) {
    if (f.mesh.triangles.size() > 3000) continue;
    SCOPED_TRACE(f.name);
    const ClosestTriangle search(f.mesh);
    const geom::Box3 box = geom::bounding_box(f.mesh);
    std::uint32_t hint = 0;
    for (int i = 0; i < 60; ++i) {
      const Vec3 p =
          box.min +
          (box.max - box.min).cwiseProduct(Vec3(unit(random), unit(random), unit(random)));
      const double found = search.squared(p, hint), expected = nearest_of_all(f.mesh, p);
      EXPECT_NEAR(std::sqrt(found), std::sqrt(expected), 1e-9 * box.diagonal());
      // The hint is the one that it is the distance of.
      EXPECT_NEAR(std::sqrt(squared_distance(p, search.corners(hint))), std::sqrt(found),
                  1e-9 * box.diagonal());
      // One that is near enough will do.
      const double enough = 4 * expected + 1e-6;
      EXPECT_LE(search.squared(p, hint, enough), std::max(enough, 1.001 * expected));
      // Also from anywhere, and where none is.
      for (const double share : {0.5, 1.5}) {
        auto far = static_cast<std::uint32_t>(random() % f.mesh.triangles.size());
        const double some = search.squared(p, far, share * expected);
        EXPECT_LE(some, std::max(share, 1.001) * expected + 1e-12);
        EXPECT_NEAR(squared_distance(p, search.corners(far)), some, 1e-12 * (1 + some));
      }
    }
  }
}

TEST(ClosestTriangle, HintsDoNotChangeTheDistance) {
  const geom::Mesh mesh = test::torus(1, 0.4, 40, 20);
  const ClosestTriangle search(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p(unit(random), unit(random), unit(random));
    std::uint32_t none = 0, other = static_cast<std::uint32_t>(random() % mesh.triangles.size());
    EXPECT_NEAR(search.squared(p, none), search.squared(p, other), 1e-12);
  }
}

// Of points in a ball, all that is gathered there gives what all of the mesh does.
TEST(ClosestTriangle, VicinitiesDoNotChangeTheDistance) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const auto& f : test::closed_families()) {
    if (f.mesh.triangles.size() > 3000) continue;
    SCOPED_TRACE(f.name);
    const ClosestTriangle search(f.mesh);
    const double size = geom::bounding_box(f.mesh).diagonal();
    ClosestTriangle::Vicinity vicinity;
    for (int i = 0; i < 20; ++i) {
      const Vec3 center = f.mesh.vertices[random() % f.mesh.vertices.size()];
      const double radius = size * std::pow(10.0, -1 - i % 3);
      std::uint64_t steps = 0;
      search.gather(center, radius, vicinity, &steps);
      EXPECT_GT(steps, 0U);
      for (int k = 0; k < 10; ++k) {
        const Vec3 p = center + 0.8 * radius * Vec3(unit(random), unit(random), unit(random));
        const auto hint = static_cast<std::uint32_t>(random() % f.mesh.triangles.size());
        std::uint32_t of_all = hint, of_some = hint;
        EXPECT_EQ(search.squared(p, of_all), search.squared(p, of_some, 0, nullptr, &vicinity));
      }
    }
  }
}

// From anywhere on a ball, the triangles that are nearer and nearer lead to the nearest, but for a
// limit of steps; what is found is never nearer than it is.
TEST(ClosestTriangle, NearTheHintFindsTheNearestOfARoundBody) {
  const geom::Mesh mesh = test::icosphere(3);
  const ClosestTriangle search(mesh);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  int same = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = 1.2 * Vec3(unit(random), unit(random), unit(random)).normalized();
    std::uint32_t exact = 0;
    search.squared(p, exact);
    // Points near by are near triangles near by.
    std::uint32_t hint = exact;
    const Vec3 q = p + 0.05 * Vec3(unit(random), unit(random), unit(random));
    const double found = search.squared_near(q, hint), nearest = nearest_of_all(mesh, q);
    EXPECT_GE(found, nearest);
    EXPECT_EQ(squared_distance(q, search.corners(hint)), found);
    same += found == nearest ? 1 : 0;
    // Near enough is near enough.
    std::uint32_t first = exact;
    search.squared_near(q, first, 100);
    EXPECT_EQ(first, exact);
  }
  EXPECT_GE(same, 295);
}

// Of a flat star whose original bulges beyond one of its triangles, that one's half-space keeps the
// bulge inside, whatever the direction.
TEST(SupportPlanes, KeepsPointsOfTheOriginalBehindThePlanes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const double sign : {1.0, -1.0}) {
    for (int round = 0; round < 200; ++round) {
      const Vec3 apex(0, 0, 0), p(1, 0, 0), q(0, 1, 0);
      SupportPlanes planes(sign);
      const std::vector<NewTriangle> star{{0, {apex, p, q}}};
      planes.assign(star);
      const double s = unit(random), t = unit(random) * (1 - s);
      const Vec3 bulge = 0.9 * (s * p + t * q) + Vec3(0, 0, sign * (0.01 + 0.2 * unit(random)));
      planes.keep(0, bulge);
      std::vector<HalfSpace> half_spaces;
      planes.half_spaces(Vec3::Zero(), half_spaces);
      ASSERT_EQ(half_spaces.size(), 1U);
      // An apex on the boundary of the half-space: its plane through (p, q) passes the bulge.
      const Vec3 moved = half_spaces[0].normal * half_spaces[0].offset;
      const Vec3 n = (p - moved).cross(q - moved);
      EXPECT_NEAR(n.normalized().dot(bulge - moved), 0, 1e-12);
      // Further out it is behind the plane, further in it sticks out.
      const Vec3 out = moved + 0.1 * half_spaces[0].normal,
                 in = moved - 0.05 * half_spaces[0].normal;
      EXPECT_LT(sign * (p - out).cross(q - out).dot(bulge - out), 0);
      EXPECT_GT(sign * (p - in).cross(q - in).dot(bulge - in), 0);
    }
  }
}

TEST(SupportPlanes, ArePushedByRounding) {
  SupportPlanes planes(1);
  const std::vector<NewTriangle> star{{0, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}}};
  planes.assign(star);
  planes.keep(0, {0.3, 0.3, 0.1});
  std::vector<HalfSpace> without, with;
  planes.half_spaces(Vec3::Zero(), without);
  planes.half_spaces(Vec3::Constant(1e-3), with);
  ASSERT_EQ(with.size(), 1U);
  EXPECT_GT(with[0].offset, without[0].offset + 0.5e-3 * with[0].normal.cwiseAbs().sum());
}

}  // namespace
}  // namespace kaboum::bmesh
