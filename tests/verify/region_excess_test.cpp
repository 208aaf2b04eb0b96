// What bodies hold of a region, and how far that is from a solid: distances that are known, and
// random bodies and regions against points.
#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/verify/region_excess.h>

#include <cmath>
#include <random>

namespace kaboum::verify {
namespace {

using geom::BoundedRegion;
using geom::ConvexBody;
using geom::ConvexSet;
using geom::Mesh;
using geom::Region;
using geom::Vec3;

Mesh box_between(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                         (i & 4) != 0 ? high.z() : low.z());
  return *geom::convex_hull(corners);
}

Mesh cube() { return box_between({-1, -1, -1}, {1, 1, 1}); }

/// Of the cube.
double distance_of(const Vec3& p) {
  return (p.cwiseAbs() - Vec3::Ones()).cwiseMax(Vec3::Zero()).norm();
}

Region half_space(const Vec3& normal, double offset) {
  Region out;
  out.sides = {{normal.normalized(), offset}};
  return out;
}

Region ball_region(const Vec3& center, double radius) {
  Region out;
  out.center = center;
  out.radius = radius;
  return out;
}

Answer answer(const ConvexSet& set, const Region& region, double epsilon) {
  return verify_region_excess(set, cube(), {"it", region, epsilon}, true).answer;
}

ConvexSet set_of(ConvexBody body) {
  ConvexSet out;
  out.bodies.push_back(std::move(body));
  return out;
}

TEST(RegionExcess, OfABoxOverACubeIsWhereThePlaneIs) {
  const ConvexSet set = set_of({"box", box_between({-1, -1, -1}, {1, 1, 2}), 0});
  for (const double height : {1.01, 1.25, 1.5, 1.999}) {
    const Region below = half_space({0, 0, 1}, height);
    EXPECT_EQ(answer(set, below, (height - 1) * (1 + 1e-7)), Answer::Verified) << height;
    EXPECT_EQ(answer(set, below, (height - 1) * (1 - 1e-7)), Answer::Refuted) << height;
  }
  EXPECT_EQ(answer(set, half_space({0, 0, 1}, 3), 1.0001), Answer::Verified);
  EXPECT_EQ(answer(set, half_space({0, 0, 1}, 3), 0.9999), Answer::Refuted);
  // Tilted planes: x + z ≤ 1.5 leaves (−1, y, 2), x + z ≤ 0.5 leaves (−1, y, 1.5).
  EXPECT_EQ(answer(set, half_space({1, 0, 1}, 1.5 / std::sqrt(2)), 1 - 1e-6), Answer::Refuted);
  EXPECT_EQ(answer(set, half_space({1, 0, 1}, 0.5 / std::sqrt(2)), 0.5 + 1e-6), Answer::Verified);
  EXPECT_EQ(answer(set, half_space({1, 0, 1}, 0.5 / std::sqrt(2)), 0.5 - 1e-6), Answer::Refuted);
}

TEST(RegionExcess, OfWhatIsApartIsNothing) {
  const ConvexSet box = set_of({"box", box_between({-1, -1, -1}, {1, 1, 2}), 0});
  EXPECT_EQ(answer(box, half_space({0, 0, -1}, -2.001), 1e-6), Answer::Verified);
  EXPECT_EQ(answer(box, half_space({0, 0, -1}, -1.9), 1e-6), Answer::Refuted);
  const ConvexSet ball = set_of({"ball", {{Vec3(0, 0, 1)}, {}}, 1});
  EXPECT_EQ(answer(ball, half_space({0, 0, -1}, -2.001), 1e-6), Answer::Verified);
  EXPECT_EQ(answer(ball, half_space({0, 0, -1}, -1.9), 1e-6), Answer::Refuted);
  EXPECT_EQ(answer(ball, ball_region({0, 0, 3}, 0.999), 1e-6), Answer::Verified);
  EXPECT_EQ(answer(ball, ball_region({0, 0, 3}, 1.1), 1e-6), Answer::Refuted);
}

TEST(RegionExcess, BallsThatNearlyTouchHullsAreApart) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  const auto at = [&] { return Vec3(place(random), place(random), place(random)); };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 3 + trial % 20; ++i) corners.push_back(at());
    // A point over the middle of a facet, an edge or a corner.
    const auto hull = geom::convex_hull(corners);
    if (!hull) continue;
    const geom::Triangle& t = hull->triangles[trial % hull->triangles.size()];
    const Vec3 &a = hull->vertices[t[0]], &b = hull->vertices[t[1]], &c = hull->vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const Vec3 on = trial % 3 == 0 ? Vec3((a + b + c) / 3) : trial % 3 == 1 ? Vec3((a + b) / 2) : a;
    const double away = 0.01 + 0.5 * std::abs(place(random));
    const Region region = ball_region(on + away * normal, 0);
    EXPECT_NEAR(geom::distance_from(region, hull->vertices), away, 1e-9) << trial;
    EXPECT_LE(geom::distance_from(region, hull->vertices), away + 1e-12) << trial;
  }
}

TEST(RegionExcess, NoPointOfAVerifiedRegionIsFarther) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-1.5, 1.5), size(0.2, 1.2), share(0.3, 1.2);
  const auto at = [&] { return Vec3(place(random), place(random), place(random)); };
  int verified = 0, refuted = 0;
  for (int trial = 0; trial < 60; ++trial) {
    ConvexBody body;
    std::vector<Vec3> core{at()};
    if (trial % 4 == 1) core.push_back(at());
    if (trial % 4 > 1)
      for (int i = 0; i < 8; ++i) core.push_back(at());
    body.radius = trial % 4 == 3 ? 0 : size(random);
    body.core.vertices = core;
    if (core.size() > 2) body.core = *geom::convex_hull(core);
    Region region;
    const Vec3 middle = at();
    if (trial % 3 == 0)
      region = half_space(at(), size(random) - 0.5);
    else if (trial % 3 == 1)
      region = ball_region(middle, size(random));
    else
      region = geom::box_region({middle - Vec3::Constant(size(random)), middle + Vec3::Ones()});
    // Points of the body in the region.
    double farthest = 0;
    std::uniform_real_distribution<double> weight(0, 1);
    std::vector<Vec3> points;
    for (int i = 0; i < 4000; ++i) {
      Vec3 p = Vec3::Zero();
      double sum = 0;
      for (const Vec3& v : core) {
        const double w = -std::log(weight(random) + 1e-300);
        p += w * v;
        sum += w;
      }
      p /= sum;
      const Vec3 way = at();
      if (way.norm() > 0) p += body.radius * std::cbrt(weight(random)) * way.normalized();
      if (!holds(region, p)) continue;
      farthest = std::max(farthest, distance_of(p));
    }
    const double epsilon = std::max(0.02, share(random) * farthest);
    const Answer found = answer(set_of(body), region, epsilon);
    if (found == Answer::Verified) {
      EXPECT_LE(farthest, epsilon) << trial;
    }
    verified += found == Answer::Verified ? 1 : 0;
    refuted += found == Answer::Refuted ? 1 : 0;
    if (farthest > 1.05 * epsilon) {
      EXPECT_EQ(found, Answer::Refuted) << trial;
    }
  }
  EXPECT_GT(verified, 10);
  EXPECT_GT(refuted, 10);
}

}  // namespace
}  // namespace kaboum::verify
