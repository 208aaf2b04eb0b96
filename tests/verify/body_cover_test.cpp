// Unions of capsules, boxes and balls against rational distances by CGAL, voids, radii one ulp
// round the least, bodies that touch with no slack.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/verify/body_cover.h>
#include <kaboum/verify/cover.h>

#include <cmath>
#include <random>

namespace kaboum::verify {
namespace body_cover_test {
namespace {

using geom::ConvexSet;
using geom::Mesh;
using geom::Vec3;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;

Mesh box_of(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                         (i & 4) != 0 ? high.z() : low.z());
  return *geom::convex_hull(corners);
}

Mesh cube(double half) { return box_of(Vec3::Constant(-half), Vec3::Constant(half)); }

void add_ball(ConvexSet& set, const Vec3& c, double radius) {
  set.bodies.push_back({"ball", {{c}, {}}, radius});
}
void add_capsule(ConvexSet& set, const Vec3& from, const Vec3& to, double radius) {
  set.bodies.push_back({"capsule", {{from, to}, {}}, radius});
}
void add_box(ConvexSet& set, const Vec3& low, const Vec3& high, double radius = 0) {
  set.bodies.push_back({"box", box_of(low, high), radius});
}

Kernel::Point_3 exact(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// In some body, exactly; shares nothing with what is tested.
bool oracle_holds(const geom::ConvexBody& body, const Kernel::Point_3& p) {
  const std::vector<Vec3>& v = body.core.vertices;
  const Kernel::FT square = Kernel::FT(body.radius) * Kernel::FT(body.radius);
  if (body.core.triangles.empty()) {
    if (v.size() == 1) return CGAL::squared_distance(p, exact(v[0])) <= square;
    return CGAL::squared_distance(p, Kernel::Segment_3(exact(v[0]), exact(v[1]))) <= square;
  }
  bool inside = true;
  for (const geom::Triangle& t : body.core.triangles) {
    const Kernel::Triangle_3 one(exact(v[t[0]]), exact(v[t[1]]), exact(v[t[2]]));
    if (body.radius > 0 && CGAL::squared_distance(p, one) <= square) return true;
    inside = inside && CGAL::orientation(one[0], one[1], one[2], p) != CGAL::POSITIVE;
  }
  return inside;
}

bool oracle_holds(const ConvexSet& set, const Vec3& p) {
  return std::ranges::any_of(
      set.bodies, [&](const geom::ConvexBody& body) { return oracle_holds(body, exact(p)); });
}

// The corners of a bar and the least capsule that holds them: they decide.
TEST(BodyCover, OneUlpDecides) {
  const Mesh original = box_of({-3, -1, -1}, {3, 1, 1});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> near(-0.1, 0.1);
  int verified = 0, refuted = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 from(-2 + near(random), near(random), near(random)),
        to(2 + near(random), near(random), near(random));
    double radius = 0;
    for (const Vec3& v : original.vertices) {
      const double share =
          std::clamp((v - from).dot(to - from) / (to - from).squaredNorm(), 0., 1.);
      radius = std::max(radius, (v - from - share * (to - from)).norm());
    }
    for (int k = 0; k < 2; ++k) radius = std::nextafter(radius, 0);
    for (int k = 0; k < 5; ++k, radius = std::nextafter(radius, 9)) {
      ConvexSet set;
      add_capsule(set, from, to, radius);
      bool held = true;
      for (const Vec3& v : original.vertices) held = held && oracle_holds(set, v);
      const Inclusion found = verify_body_cover(original, set);
      EXPECT_EQ(found.surface.answer, held ? Answer::Verified : Answer::Refuted);
      EXPECT_EQ(found.solid.answer == Answer::Verified, held);
      (held ? verified : refuted) += 1;
    }
  }
  EXPECT_GT(verified, 100);
  EXPECT_GT(refuted, 100);
}

// A corner of a box that is one ulp too short, on coordinates that are no float32 numbers.
TEST(BodyCover, ABoxIsExact) {
  const Vec3 high(1.1, 1.3, 1.7);
  const Mesh original = box_of(-high, high);
  for (int k = 0; k < 3; ++k)
    for (const int ulps : {-1, 0, 1}) {
      Vec3 own = high;
      if (ulps != 0) own[k] = std::nextafter(own[k], ulps > 0 ? 9 : 0);
      ConvexSet set;
      add_box(set, -own, own);
      add_ball(set, {9, 9, 9}, 1);  // another kind beside it
      const Cover found = verify_cover(original, set);
      EXPECT_EQ(found.inclusion.surface.answer, ulps < 0 ? Answer::Refuted : Answer::Verified);
      EXPECT_EQ(found.inclusion.solid.answer == Answer::Verified, ulps >= 0);
    }
}

/// Six boxes that hold the surface of a cube of half edge 1 and leave a cube of half edge `hollow`.
ConvexSet walls(double hollow, const Vec3& shift) {
  ConvexSet set;
  for (int k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0}) {
      Vec3 low = Vec3::Constant(-1.125), high = Vec3::Constant(1.125);
      (sign > 0 ? low : high)[k] = sign * hollow;
      add_box(set, low + shift, high + shift);
    }
  return set;
}

TEST(BodyCover, VoidsOfAnySizeAreFound) {
  const Vec3 shift(0.1234375, 0.765625, 0.3359375);  // dyadic: all corners are exact
  Mesh original = cube(1);
  for (Vec3& v : original.vertices) v += shift;
  for (const double hollow : {0.5, 0.0625, 0x1p-12, 0x1p-20}) {
    ConvexSet set = walls(hollow, shift);
    add_ball(set, Vec3(5, 5, 5), 1);
    const Inclusion open = verify_body_cover(original, set);
    EXPECT_EQ(open.surface.answer, Answer::Verified);
    EXPECT_EQ(open.solid.answer, Answer::Refuted) << hollow;
    // What fills it but for its corners, and all of it.
    for (const bool full : {false, true}) {
      const double radius = std::sqrt(3.0) * hollow * (full ? 1.01 : 0.99);
      ConvexSet ball = set, capsule = set;
      add_ball(ball, shift, radius);
      add_capsule(capsule, shift, shift + Vec3(hollow, 0, 0) / 8, radius);
      EXPECT_EQ(verify_body_cover(original, ball).solid.answer,
                full ? Answer::Verified : Answer::Refuted)
          << hollow;
      EXPECT_EQ(verify_body_cover(original, capsule).solid.answer,
                full ? Answer::Verified : Answer::Refuted)
          << hollow;
    }
  }
}

TEST(BodyCover, BodiesThatTouchAreNeverRefutedNorGapsVerified) {
  const Mesh original = cube(1);
  for (const double gap : {0.0, 0x1p-52, 0x1p-30}) {
    ConvexSet set;
    add_box(set, {-1.5, -1.5, -1.5}, {0, 1.5, 1.5});
    add_box(set, {gap, -1.5, -1.5}, {1.5, 1.5, 1.5});
    add_ball(set, {9, 9, 9}, 1);
    const Inclusion found = verify_body_cover(original, set);
    if (gap == 0) {
      EXPECT_NE(found.surface.answer, Answer::Refuted);
      EXPECT_NE(found.solid.answer, Answer::Refuted);
    } else {
      EXPECT_NE(found.surface.answer, Answer::Verified) << gap;
      EXPECT_NE(found.solid.answer, Answer::Verified) << gap;
    }
  }
}

TEST(BodyCover, RoundedPolytopesAreDecided) {
  const Mesh original = cube(1);
  for (const double radius : {0.49, 0.51}) {
    ConvexSet set;
    // A smaller cube with a radius: its corners are the last to hold those of the original.
    add_box(set, Vec3::Constant(-1 + radius / std::sqrt(3.0) - 0.005),
            Vec3::Constant(1 - 0.5 / std::sqrt(3.0)), radius);
    add_capsule(set, {5, 5, 5}, {6, 5, 5}, 1);
    const Inclusion found = verify_body_cover(original, set);
    EXPECT_EQ(found.surface.answer, radius > 0.5 ? Answer::Verified : Answer::Refuted);
    EXPECT_EQ(found.solid.answer == Answer::Verified, radius > 0.5);
  }
}

TEST(BodyCover, WhatHasNoRadiusIsNoCapsule) {
  const Mesh original = cube(1);
  for (const double radius : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    ConvexSet set;
    add_capsule(set, {0, 0, 0}, {1, 0, 0}, radius);
    add_ball(set, {0, 0, 0}, 3);
    const Cover found = verify_cover(original, set);
    EXPECT_EQ(found.convexity.convex.answer, Answer::Refuted) << radius;
    EXPECT_NE(found.inclusion.solid.answer, Answer::Verified) << radius;
  }
}

// Random bodies, against points of a grid: no verified cover leaves one out, and what is refuted
// has a witness.
TEST(BodyCover, AgreesWithPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-0.8, 0.8), size(0.6, 1.7);
  const Mesh original = cube(1);
  int verified = 0, refuted = 0;
  for (int i = 0; i < 150; ++i) {
    ConvexSet set;
    const int count = 3 + i % 9;
    for (int k = 0; k < count; ++k) {
      const Vec3 a(at(random), at(random), at(random)), b(at(random), at(random), at(random));
      const double r = size(random);
      if (k % 3 == 0) add_capsule(set, a, b, r);
      if (k % 3 == 1) add_box(set, a.cwiseMin(b) - Vec3::Constant(r), a.cwiseMax(b));
      if (k % 3 == 2) add_box(set, a - Vec3::Constant(0.3), a + Vec3(0.1, 0.2, r), r);
    }
    const Inclusion found = verify_body_cover(original, set);
    bool missed = false;
    constexpr int kGrid = 12;
    for (int n = 0; n < kGrid * kGrid * kGrid && !missed; ++n) {
      const Vec3 p(2.0 * (n % kGrid) / (kGrid - 1) - 1, 2.0 * (n / kGrid % kGrid) / (kGrid - 1) - 1,
                   2.0 * (n / kGrid / kGrid) / (kGrid - 1) - 1);
      missed = !oracle_holds(set, p);
    }
    if (missed)
      EXPECT_FALSE(found.solid.answer == Answer::Verified &&
                   found.surface.answer == Answer::Verified)
          << i;
    for (const Claim* claim : {&found.solid, &found.surface}) {
      EXPECT_NE(claim->answer, Answer::Undefined);
      if (claim->answer != Answer::Refuted) continue;
      ASSERT_TRUE(claim->witness);
      if (claim->witness->exact) EXPECT_FALSE(oracle_holds(set, claim->witness->point)) << i;
    }
    verified += found.solid.answer == Answer::Verified ? 1 : 0;
    refuted += found.solid.answer == Answer::Refuted ? 1 : 0;
  }
  EXPECT_GT(verified, 10);
  EXPECT_GT(refuted, 10);
}

}  // namespace
}  // namespace body_cover_test
}  // namespace kaboum::verify
