// How far balls, capsules and boxes, rounded or not, reach from solids: distances that are known,
// random bodies against points and a formula of boxes, regions, scales, and mutants of the bodies.
#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/region_excess.h>

#include <cmath>
#include <random>

#include "body_excess.h"

namespace kaboum::verify {
namespace {

using geom::Box3;
using geom::ConvexBody;
using geom::ConvexSet;
using geom::Mesh;
using geom::Vec3;

using Turn = Eigen::Quaterniond;

std::vector<Vec3> corners_of(const Box3& box) {
  std::vector<Vec3> out;
  for (int i = 0; i < 8; ++i)
    out.emplace_back((i & 1) != 0 ? box.max.x() : box.min.x(),
                     (i & 2) != 0 ? box.max.y() : box.min.y(),
                     (i & 4) != 0 ? box.max.z() : box.min.z());
  return out;
}

/// Boxes that may meet, as one closed chain, turned and moved.
struct Boxes {
  std::vector<Box3> boxes;
  Turn turn = Turn::Identity();
  Vec3 moved = Vec3::Zero();

  [[nodiscard]] Vec3 place(const Vec3& p) const { return turn * p + moved; }
  [[nodiscard]] Mesh mesh() const {
    Mesh out;
    for (const Box3& box : boxes) {
      const Mesh one = *geom::convex_hull(corners_of(box));
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      for (const Vec3& p : one.vertices) out.vertices.push_back(place(p));
      for (const geom::Triangle& t : one.triangles)
        out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return out;
  }
  /// Of a point of space, by a formula that the verifier does not know.
  [[nodiscard]] double distance(const Vec3& p) const {
    const Vec3 q = turn.conjugate() * (p - moved);
    double out = std::numeric_limits<double>::infinity();
    for (const Box3& box : boxes)
      out = std::min(out, (q - q.cwiseMax(box.min).cwiseMin(box.max)).norm());
    return out;
  }
};

Box3 box_of(const Vec3& low, const Vec3& high) {
  Box3 out;
  out.extend(low);
  out.extend(high);
  return out;
}

Boxes cube(double half) { return {{box_of(Vec3::Constant(-half), Vec3::Constant(half))}}; }

ConvexBody rounded_box(const Vec3& center, const Turn& turn, const Vec3& half, double radius) {
  std::vector<Vec3> corners = corners_of(box_of(-half, half));
  for (Vec3& p : corners) p = center + turn * p;
  return {"box", *geom::convex_hull(corners), radius};
}
ConvexBody capsule(const Vec3& a, const Vec3& b, double radius) {
  return {"capsule", {{a, b}, {}}, radius};
}
ConvexBody ball(const Vec3& c, double radius) { return {"ball", {{c}, {}}, radius}; }

ConvexSet set_of(std::vector<ConvexBody> bodies) {
  ConvexSet out;
  out.bodies = std::move(bodies);
  return out;
}

Answer answer(const ConvexSet& set, const Mesh& mesh, double epsilon) {
  EXPECT_TRUE(have_cells(set));
  return verify_body_excess(set, mesh, epsilon).answer;
}

void expect_farthest(const ConvexSet& set, const Mesh& mesh, double farthest, double share = 1e-3) {
  EXPECT_EQ(answer(set, mesh, farthest * (1 + share)), Answer::Verified) << farthest;
  EXPECT_EQ(answer(set, mesh, farthest * (1 - share)), Answer::Refuted) << farthest;
}

TEST(BodyExcess, OfKnownBodies) {
  const Mesh unit = cube(0.5).mesh();
  expect_farthest(set_of({capsule({-1, 0, 0}, {1, 0, 0}, 0.75)}), unit, 1.25);
  expect_farthest(set_of({capsule({0, 0, -0.2}, {0, 0, 0.2}, 0.6)}), unit, 0.3);
  expect_farthest(set_of({ball({0, 0, 0}, 1), ball({0.1, 0, 0}, 0.4)}), unit, 0.5);
  // Over an edge, and over a corner.
  expect_farthest(set_of({capsule({0.5, 0.5, -0.3}, {0.5, 0.5, 0.3}, 0.1)}), unit, 0.1);
  expect_farthest(set_of({ball({0.6, 0.6, 0.6}, 0.2)}), unit, 0.2 + 0.1 * std::sqrt(3.0));
  expect_farthest(set_of({rounded_box({0, 0, 0}, Turn::Identity(), {0.6, 0.7, 0.5}, 0)}), unit,
                  std::hypot(0.1, 0.2));
  expect_farthest(set_of({rounded_box({0, 0, 0}, Turn::Identity(), {0.6, 0.7, 0.5}, 0.05)}), unit,
                  std::hypot(0.1, 0.2) + 0.05);
}

TEST(BodyExcess, OfBoxesAlongFaces) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> any(-1, 1), size(0.1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3 half(size(random), size(random), size(random));
    Boxes solid{{box_of(-half, half)}};
    solid.turn = Turn::UnitRandom();
    solid.moved = Vec3(any(random), any(random), any(random));
    const Vec3 larger = half + Vec3(0.1, 0.05 * size(random), 0);
    const ConvexSet set = set_of({rounded_box(solid.moved, solid.turn, larger, 0)});
    expect_farthest(set, solid.mesh(), (larger - half).norm(), 1e-2);
  }
}

// Where shells meet or cross, walls are no border of the solid.
TEST(BodyExcess, WallsInsideCountAsNear) {
  const Boxes solid{{box_of({-2, -0.5, -0.5}, {0, 0.5, 0.5}),
                     box_of({0, -0.5, -0.5}, {2, 0.5, 0.5}),
                     box_of({-1, -0.4, -0.4}, {1, 0.4, 0.4})}};
  expect_farthest(set_of({capsule({-1.5, 0, 0}, {1.5, 0, 0}, 0.6)}), solid.mesh(), 0.1);
}

// A cavity is farther away in its middle than on any surface.
TEST(BodyExcess, CavitiesCount) {
  Mesh hollow = cube(1).mesh();
  Mesh inner = cube(0.5).mesh();
  for (geom::Triangle& t : inner.triangles) std::swap(t[1], t[2]);
  for (const geom::Triangle& t : inner.triangles)
    hollow.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  hollow.vertices.insert(hollow.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  expect_farthest(set_of({capsule({-0.3, 0, 0}, {0.3, 0, 0}, 0.9)}), hollow, 0.5);
  expect_farthest(set_of({rounded_box({0, 0, 0}, Turn::Identity(), {1, 1, 1}, 0)}), hollow, 0.5);
  expect_farthest(set_of({ball({0.9, 0, 0}, 0.6)}), hollow, 0.5, 1e-2);
}

TEST(BodyExcess, NoPointOfVerifiedBodiesIsFarther) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> any(-1, 1), size(0.1, 0.6);
  const auto at = [&] { return Vec3(any(random), any(random), any(random)); };
  for (int trial = 0; trial < 60; ++trial) {
    Boxes solid;
    for (int i = 0; i <= trial % 3; ++i) {
      const Vec3 c = at(), half(size(random), size(random), size(random));
      solid.boxes.push_back(box_of(c - half, c + half));
    }
    if (trial % 2 != 0) {
      solid.turn = Turn::UnitRandom();
      solid.moved = at();
    }
    const double radius = trial % 5 == 4 ? 0 : size(random);
    ConvexBody body = ball(at(), radius);
    if (trial % 3 == 1) body = capsule(at(), at(), radius);
    if (trial % 3 == 2 || radius == 0)
      body =
          rounded_box(at(), Turn::UnitRandom(), {size(random), size(random), size(random)}, radius);
    // Points of the body: corners of its core, and all of its border in random directions.
    double farthest = 0;
    for (int k = 0; k < 40'000; ++k) {
      Vec3 p = Vec3::Zero();
      double sum = 0;
      for (const Vec3& v : body.core.vertices) {
        const double w = k % 3 == 0 ? std::pow(size(random), 8) : size(random);
        p += w * v;
        sum += w;
      }
      p /= sum;
      if (k % 2 == 0)
        p = body.core.vertices[static_cast<std::size_t>(k / 2) % body.core.vertices.size()];
      farthest = std::max(farthest, solid.distance(p + radius * at().normalized()));
    }
    if (!(farthest > 0.02)) continue;
    const Mesh mesh = solid.mesh();
    const ConvexSet set = set_of({body});
    EXPECT_EQ(answer(set, mesh, 0.999 * farthest), Answer::Refuted) << trial;
    EXPECT_EQ(answer(set, mesh, 1.05 * farthest), Answer::Verified) << trial;
    const DistanceClaim claim = verify_body_excess(set, mesh, 0.9 * farthest);
    EXPECT_GT(solid.distance(claim.at), 0.9 * farthest);
    EXPECT_NEAR(solid.distance(claim.at), claim.largest, 1e-9);
  }
}

// With one body a little larger, what was verified is refuted.
TEST(BodyExcess, LargerBodiesAreRefuted) {
  const Boxes solid{{box_of({-1, -0.2, -0.2}, {1, 0.2, 0.2}), box_of({-0.2, -1, -1}, {0.2, 1, 1})}};
  const Mesh mesh = solid.mesh();
  std::vector<ConvexBody> bodies;
  for (int i = 0; i < 40; ++i) {
    const double x = -0.75 + 0.035 * i;
    bodies.push_back(capsule({x, 0, 0}, {x + 0.1, 0, 0}, 0.3));
  }
  EXPECT_EQ(answer(set_of(bodies), mesh, 0.1001), Answer::Verified);
  for (const std::size_t k : {std::size_t{0}, std::size_t{17}, std::size_t{39}}) {
    std::vector<ConvexBody> mutant = bodies;
    mutant[k].radius *= 1.01;
    const DistanceClaim claim = verify_body_excess(set_of(mutant), mesh, 0.1001);
    // Over the other beam there is room.
    const bool is_beside = std::abs(mutant[k].core.vertices[0].x()) > 0.3;
    EXPECT_EQ(claim.answer, is_beside ? Answer::Refuted : Answer::Verified) << k;
  }
}

TEST(BodyExcess, Scales) {
  for (const int power : {-300, -40, 40, 200}) {
    const double s = std::ldexp(1, power);
    Mesh mesh = cube(0.5).mesh();
    for (Vec3& p : mesh.vertices) p *= s;
    ConvexBody body = capsule({-s, 0, 0}, {s, 0, 0}, 0.75 * s);
    EXPECT_EQ(answer(set_of({body}), mesh, 1.2501 * s), Answer::Verified) << power;
    EXPECT_EQ(answer(set_of({body}), mesh, 1.2499 * s), Answer::Refuted) << power;
  }
  // A body that is far from the size of the mesh is never said to be near by overflow.
  const Mesh mesh = cube(1e-200).mesh();
  EXPECT_NE(answer(set_of({capsule({0, 0, 0}, {1, 0, 0}, 0.5)}), mesh, 0.1), Answer::Verified);
}

// Fifty boxes in a ball and round it, all of which meet: pieces of their facets are too many.
TEST(BodyExcess, BoxesThatAllMeetHoldABall) {
  std::vector<Vec3> points;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 160; ++i)
    points.push_back(Vec3(normal(random), normal(random), normal(random)).normalized());
  const Mesh ball = *geom::convex_hull(points);
  std::vector<ConvexBody> bodies;
  for (int i = 0; i < 25; ++i) {
    const Turn turn(
        Turn(normal(random), normal(random), normal(random), normal(random)).normalized());
    bodies.push_back(rounded_box(Vec3::Zero(), turn, Vec3(1.02, 0.45, 0.45), 0));
    bodies.push_back(rounded_box(Vec3::Zero(), turn, Vec3(0.3, 0.3, 1.02), 0));
  }
  bodies.push_back(rounded_box(Vec3::Zero(), Turn::Identity(), Vec3(0.99, 0.99, 0.99), 0));
  const Cover cover = verify_cover(ball, set_of(bodies));
  EXPECT_NE(cover.inclusion.surface.answer, Answer::Undecided);
  EXPECT_NE(cover.inclusion.solid.answer, Answer::Undecided);
}

// Axes of cores so small that squares of their coordinates are denormal.
TEST(BodyExcess, CoresThatAreNearlyPoints) {
  const std::vector<Box3> slabs{box_of({-0.5, -2, -2}, {0.5, 2, 2}),
                                box_of({-2, -0.5, -2}, {2, 0.5, 2}),
                                box_of({-2, -2, -0.5}, {2, 2, 0.5})};
  for (const Box3& slab : slabs) {
    const Mesh mesh = Boxes{{slab}}.mesh();
    for (const int power : {-530, -536, -537, -538, -539, -540, -1000})
      for (const double share : {1.0, 1.3, 1.7}) {
        const double length = std::ldexp(share, power);
        for (const Vec3& end : {Vec3(length, 0, 0), Vec3(0, length, 0), Vec3(length, 0, length)}) {
          EXPECT_NE(answer(set_of({capsule(Vec3::Zero(), end, 1)}), mesh, 0.499), Answer::Verified);
          EXPECT_EQ(answer(set_of({capsule(Vec3::Zero(), end, 1)}), mesh, 0.501), Answer::Verified);
        }
      }
    for (const int power : {-20, -266, -268, -269, -270})
      for (const double share : {1.0, 1.4}) {
        const Vec3 half = Vec3::Constant(std::ldexp(share, power));
        EXPECT_NE(verify_body_excess(set_of({rounded_box({0, 0, 0}, Turn::Identity(), half, 1)}),
                                     mesh, 0.499)
                      .answer,
                  Answer::Verified);
      }
  }
}

TEST(BodyExcess, NumbersThatAreNoneAreNoBodies) {
  const Mesh mesh = cube(0.5).mesh();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ConvexSet& set : {set_of({capsule({0, 0, 0}, {nan, 0, 0}, 0.6)}),
                               set_of({capsule({nan, 0, 0}, {0, 0, 0}, 0.6)}),
                               set_of({ball({0, 0, nan}, 0.6)}), set_of({ball({0, 0, 0}, nan)})}) {
    EXPECT_FALSE(have_cells(set));
    EXPECT_NE(verify_excess(set, mesh, 0.2, true).answer, Answer::Verified);
  }
}

// Vertices of no triangle do not count.
TEST(BodyExcess, StrayVertices) {
  Mesh mesh = cube(0.5).mesh();
  mesh.vertices.emplace_back(1e165, 0, 0);
  EXPECT_EQ(answer(set_of({ball({5, 0, 0}, 0.1)}), mesh, 0.1), Answer::Refuted);
  EXPECT_EQ(answer(set_of({ball({0.5, 0, 0}, 0.1)}), mesh, 0.11), Answer::Verified);
}

// What is not decided of some bodies does not hide others that are far.
TEST(BodyExcess, OneOfManyIsFar) {
  std::vector<ConvexBody> bodies(40, ball({0, 0, 0}, 0.75));
  bodies.push_back(ball({50, 0, 0}, 0.1));
  const DistanceClaim claim = verify_excess(set_of(bodies), cube(0.5).mesh(), 0.25, true);
  EXPECT_EQ(claim.answer, Answer::Refuted);
  EXPECT_GT(claim.largest, 49);
}

// A margin that is larger than epsilon may be within it all the same, inside a solid.
TEST(BodyExcess, MarginsAboveEpsilon) {
  const Mesh mesh = cube(0.5).mesh();
  const ConvexSet deep =
      set_of({rounded_box({0, 0, 0}, Turn::Identity(), Vec3::Constant(0.4375), 0.1875)});
  EXPECT_EQ(verify_excess(deep, mesh, 0.126, true).answer, Answer::Verified);
  EXPECT_NE(verify_excess(deep, mesh, 0.1249, true).answer, Answer::Verified);
  const std::vector<Vec3> corners{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
  EXPECT_NE(
      verify_excess(set_of({{"hull", *geom::convex_hull(corners), 1}}), mesh, 0.1, true).answer,
      Answer::Verified);
}

// The triangle that is named is one of the body that refutes.
TEST(BodyExcess, TheTriangleOfAWitness) {
  const ConvexSet set = set_of({rounded_box({0, 0, 0}, Turn::Identity(), {0.5, 0.5, 0.5}, 0),
                                rounded_box({2, 0, 0}, Turn::Identity(), {0.5, 0.5, 0.5}, 0)});
  const DistanceClaim claim = verify_excess(set, cube(0.5).mesh(), 0.1, true);
  EXPECT_EQ(claim.answer, Answer::Refuted);
  EXPECT_GE(claim.triangle, set.bodies[0].core.triangles.size());
}

TEST(BodyExcess, OnlyWhatARegionHoldsOfThemCounts) {
  const Mesh mesh = cube(0.5).mesh();
  const ConvexSet set = set_of({capsule({0, 0, 0}, {2, 0, 0}, 0.6)});
  for (const double x : {0.6, 1.0, 2.0}) {
    geom::Region region;
    region.sides = {{Vec3::UnitX(), x}};
    const double farthest = std::hypot(std::max(0.0, x - 0.5), 0.1);
    EXPECT_EQ(verify_body_excess(set, mesh, farthest * 1.02, &region, 1e-9).answer,
              Answer::Verified)
        << x;
    EXPECT_EQ(verify_body_excess(set, mesh, farthest * 0.98, &region, 1e-9).answer, Answer::Refuted)
        << x;
  }
  geom::Region apart;
  apart.center = {0, 0, 2};
  apart.radius = 1;
  EXPECT_EQ(verify_body_excess(set, mesh, 1e-3, &apart, 1e-9).answer, Answer::Verified);
}

// Hulls of random points at unions of boxes: as above, and closer, as their farthest points are
// corners.
TEST(BodyExcess, OfHullsIsThatOfTheirFarthestPoint) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-1, 1), size(0.1, 0.6);
  const auto at = [&] { return Vec3(any(random), any(random), any(random)); };
  int verified = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Boxes solid;
    for (int i = 0; i <= trial % 4; ++i) {
      const Vec3 c = 0.5 * at(), half(size(random), size(random), size(random));
      solid.boxes.push_back(box_of(c - half, c + half));
    }
    solid.turn = Turn::UnitRandom();
    std::vector<Vec3> points;
    for (int i = 0; i < 4 + trial % 30; ++i) points.push_back(0.7 * at());
    const ConvexBody body{"hull", *geom::convex_hull(points), 0};
    double farthest = 0;
    for (int k = 0; k < 20'000; ++k) {
      Vec3 p = body.core.vertices[static_cast<std::size_t>(k) % body.core.vertices.size()];
      for (int turn = 0; turn < k % 4; ++turn) {
        const Vec3& q = body.core.vertices[random() % body.core.vertices.size()];
        p += (0.5 + 0.5 * any(random)) * (q - p);
      }
      farthest = std::max(farthest, solid.distance(p));
    }
    if (!(farthest > 0.02)) continue;
    const Mesh mesh = solid.mesh();
    EXPECT_EQ(answer(set_of({body}), mesh, farthest * (1 - 1e-6)), Answer::Refuted) << trial;
    verified += answer(set_of({body}), mesh, farthest * 1.01) == Answer::Verified ? 1 : 0;
    EXPECT_EQ(answer(set_of({body}), mesh, farthest * 1.1), Answer::Verified) << trial;
  }
  EXPECT_GT(verified, 40);
}

TEST(BodyExcess, OtherBodiesAreNone) {
  const std::vector<Vec3> wedge{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                {2, 2, 2}, {1, 0, 3}, {0, 1, 3}, {1, 1, -1}};
  EXPECT_FALSE(have_cells(set_of({{"hull", *geom::convex_hull(wedge), 0.1}})));
  EXPECT_TRUE(have_cells(set_of({{"hull", *geom::convex_hull(wedge), 0}})));
  ConvexBody sheared = rounded_box({0, 0, 0}, Turn::Identity(), {1, 1, 1}, 0.1);
  for (Vec3& p : sheared.core.vertices) p.x() += 0.01 * p.y();
  EXPECT_FALSE(have_cells(set_of({sheared})));
  EXPECT_TRUE(have_cells(set_of({rounded_box({3, 4, 5}, Turn::UnitRandom(), {1, 2, 3}, 0.1)})));
}

}  // namespace
}  // namespace kaboum::verify
