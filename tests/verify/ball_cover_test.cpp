// Unions of balls against rational distances by CGAL, voids, radii one ulp round the least, and
// distances that are known.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/verify/ball_cover.h>
#include <kaboum/verify/cover.h>

#include <cmath>
#include <random>

#include "support/shapes.h"

namespace kaboum::verify {
namespace ball_cover_test {
namespace {

using geom::ConvexSet;
using geom::Mesh;
using geom::Vec3;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;

Mesh box_of(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                         i & 4 ? high.z() : low.z());
  return *geom::convex_hull(corners);
}

Mesh cube(double half) { return box_of(Vec3::Constant(-half), Vec3::Constant(half)); }

void add(Mesh& to, const Mesh& from, bool turned) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (const geom::Triangle& t : from.triangles)
    to.triangles.push_back(turned ? geom::Triangle{t[0] + first, t[2] + first, t[1] + first}
                                  : geom::Triangle{t[0] + first, t[1] + first, t[2] + first});
}

void add_ball(ConvexSet& set, const Vec3& center, double radius) {
  set.bodies.push_back({"ball", {{center}, {}}, radius});
}

/// In some ball, exactly; shares nothing with what is tested.
bool oracle_holds(const ConvexSet& set, const Kernel::Point_3& p) {
  for (const geom::ConvexBody& body : set.bodies) {
    const Vec3& c = body.core.vertices[0];
    const Kernel::FT r(body.radius);
    if (CGAL::squared_distance(p, Kernel::Point_3(c.x(), c.y(), c.z())) <= r * r) return true;
  }
  return false;
}

TEST(BallCover, WhatIsASetOfBalls) {
  ConvexSet set;
  EXPECT_FALSE(is_set_of_balls(set));
  add_ball(set, {0, 0, 0}, 1);
  EXPECT_TRUE(is_set_of_balls(set));
  for (const double radius : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    ConvexSet other = set;
    add_ball(other, {0, 0, 0}, radius);
    EXPECT_FALSE(is_set_of_balls(other)) << radius;
    EXPECT_NE(verify_cover(cube(0.1), other).convexity.convex.answer, Answer::Verified);
  }
  set.bodies.push_back({"box", cube(1), 0});
  EXPECT_FALSE(is_set_of_balls(set));
}

// A triangle in the plane z = 0 and balls whose traces there just hold it: the least radius is
// where three circles meet in one point, and it is irrational.
TEST(BallCover, OneUlpDecides) {
  const Mesh original = cube(1);
  // The corner is the farthest point, of a ball about any centre near the middle.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> near(-0.1, 0.1);
  int verified = 0, refuted = 0;
  for (int i = 0; i < 200; ++i) {
    const double x = near(random), y = near(random), z = near(random);
    const Vec3 center(x, y, z);
    double radius = 0;
    for (const Vec3& v : original.vertices) radius = std::max(radius, (v - center).norm());
    for (int k = 0; k < 2; ++k) radius = std::nextafter(radius, 0);
    for (int k = 0; k < 5; ++k, radius = std::nextafter(radius, 9)) {
      ConvexSet set;
      add_ball(set, center, radius);
      bool held = true;
      for (const Vec3& v : original.vertices)
        held = held && oracle_holds(set, Kernel::Point_3(v.x(), v.y(), v.z()));
      const Inclusion found = verify_ball_cover(original, set);
      EXPECT_EQ(found.surface.answer, held ? Answer::Verified : Answer::Refuted);
      EXPECT_EQ(found.solid.answer == Answer::Verified, held);
      (held ? verified : refuted) += 1;
    }
  }
  EXPECT_GT(verified, 200);
  EXPECT_GT(refuted, 200);
}

// Two balls whose circle of intersection passes through a point of a side, exactly: 3² + 4² = 5².
TEST(BallCover, NoSlackIsUndecidedOrExact) {
  Mesh sheet;
  sheet.vertices = {{-4, 0, 0}, {4, 0, 0}, {4, 4, 0}, {-4, 4, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  ConvexSet set;
  add_ball(set, {-3, 0, 0}, 5);
  add_ball(set, {3, 0, 0}, 5);
  // (0, 4, 0) is on both spheres, and is a middle of a side: nothing is left to cut but its sides.
  const Answer tie = verify_ball_cover(sheet, set).surface.answer;
  EXPECT_TRUE(tie == Answer::Verified || tie == Answer::Undecided);
  for (geom::ConvexBody& body : set.bodies) body.radius = std::nextafter(5, 0);
  EXPECT_EQ(verify_ball_cover(sheet, set).surface.answer, Answer::Refuted);
  for (geom::ConvexBody& body : set.bodies) body.radius = 5.0001;
  EXPECT_EQ(verify_ball_cover(sheet, set).surface.answer, Answer::Verified);
}

TEST(BallCover, VoidsOfAnySizeAreFound) {
  // Balls about the corners hold the surface; the middle is free until they are √3 large.
  const Vec3 shift(0.1234567, 0.7654321, 0.3333333);
  Mesh original = cube(1);
  for (Vec3& v : original.vertices) v += shift;
  for (const double gap : {0.3, 1e-2, 1e-4, 1e-6, 1e-8}) {
    for (const bool is_void : {true, false}) {
      ConvexSet set;
      for (const Vec3& v : original.vertices)
        add_ball(set, v, std::sqrt(3.0) * (is_void ? 1 - 0.5 * gap : 1 + 0.5 * gap));
      const Inclusion found = verify_ball_cover(original, set);
      EXPECT_EQ(found.surface.answer, Answer::Verified);
      EXPECT_EQ(found.solid.answer, is_void ? Answer::Refuted : Answer::Verified) << gap;
      if (!is_void) continue;
      ASSERT_TRUE(found.solid.witness);
      EXPECT_TRUE(found.solid.witness->exact);
      const Vec3& p = found.solid.witness->point;
      EXPECT_FALSE(oracle_holds(set, Kernel::Point_3(p.x(), p.y(), p.z())));
      EXPECT_LT((p - shift).cwiseAbs().maxCoeff(), 1);
    }
  }
}

// What the balls leave free is a cavity of the solid, no part of it.
TEST(BallCover, ACavityNeedsNoBalls) {
  Mesh original = cube(1);
  ConvexSet set;
  for (const Vec3& v : original.vertices) add_ball(set, v, 1.45);
  EXPECT_EQ(verify_ball_cover(original, set).solid.answer, Answer::Refuted);
  Mesh hollow = original;
  add(hollow, cube(0.75), true);
  EXPECT_EQ(verify_ball_cover(hollow, set).surface.answer, Answer::Verified);
  EXPECT_EQ(verify_ball_cover(hollow, set).solid.answer, Answer::Verified);
  Mesh filled = original;  // an inner shell the same way round: wound about twice
  add(filled, cube(0.75), false);
  EXPECT_EQ(verify_ball_cover(filled, set).solid.answer, Answer::Refuted);
}

TEST(BallCover, AgreesWithPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto real = [&](double low, double high) { return low + (high - low) * unit(random); };
  int verified = 0, refuted = 0, solid_only = 0;
  for (int i = 0; i < 300; ++i) {
    const Mesh original = box_of({0, 0, 0}, {1, real(0.3, 1), real(0.3, 1)});
    const Vec3 high = original.vertices[0]
                          .cwiseMax(original.vertices[1])
                          .cwiseMax(geom::bounding_box(original).max);
    ConvexSet set;
    const int count = 4 + static_cast<int>(unit(random) * 12);
    for (int k = 0; k < count; ++k) {
      const double x = real(0, high.x()), y = real(0, high.y()), z = real(0, high.z());
      add_ball(set, {x, y, z}, real(0.25, 0.8));
    }
    const Inclusion found = verify_ball_cover(original, set);
    ASSERT_NE(found.surface.answer, Answer::Undecided) << i;
    bool inside_free = false, surface_free = false;
    for (int k = 0; k < 4000; ++k) {
      Vec3 p(real(0, high.x()), real(0, high.y()), real(0, high.z()));
      inside_free = inside_free || !oracle_holds(set, Kernel::Point_3(p.x(), p.y(), p.z()));
      const int axis = k % 3;
      p[axis] = k % 2 ? 0 : high[axis];
      surface_free = surface_free || !oracle_holds(set, Kernel::Point_3(p.x(), p.y(), p.z()));
    }
    EXPECT_FALSE(surface_free && found.surface.answer == Answer::Verified) << i;
    EXPECT_FALSE(inside_free && found.solid.answer == Answer::Verified) << i;
    // A witness is in no ball.
    for (const Claim* claim : {&found.surface, &found.solid})
      if (claim->answer == Answer::Refuted && claim->witness && claim->witness->exact) {
        const Vec3& p = claim->witness->point;
        EXPECT_FALSE(oracle_holds(set, Kernel::Point_3(p.x(), p.y(), p.z()))) << i;
      }
    verified += found.solid.answer == Answer::Verified ? 1 : 0;
    refuted += found.solid.answer == Answer::Refuted ? 1 : 0;
    solid_only += found.surface.answer != found.solid.answer ? 1 : 0;
  }
  EXPECT_GT(verified, 30);
  EXPECT_GT(refuted, 30);
}

// Against a grid of exact points fine enough to meet every void: lattice balls about lattice
// points.
TEST(BallCover, VoidsAgreeWithALattice) {
  std::mt19937 random(9);
  int voids = 0, none = 0;
  for (int i = 0; i < 150; ++i) {
    const Mesh original = cube(1);
    ConvexSet set;
    for (const Vec3& v : original.vertices) add_ball(set, v, 1.45);
    std::uniform_real_distribution<double> at(-0.2, 0.2), radius(0.5, 1);
    const int count = 1 + i % 3;
    for (int k = 0; k < count; ++k) {
      const double x = at(random), y = at(random), z = at(random);
      add_ball(set, {x, y, z}, radius(random));
    }
    const Inclusion found = verify_ball_cover(original, set);
    EXPECT_EQ(found.surface.answer, Answer::Verified);
    bool is_free = false;
    constexpr int kSteps = 24;
    for (int x = -kSteps; x <= kSteps && !is_free; ++x)
      for (int y = -kSteps; y <= kSteps && !is_free; ++y)
        for (int z = -kSteps; z <= kSteps && !is_free; ++z) {
          const double s = 0.7 / kSteps;
          bool held = false;
          for (const geom::ConvexBody& body : set.bodies)
            held = held || (Vec3(s * x, s * y, s * z) - body.core.vertices[0]).norm() <=
                               body.radius + 1e-12;
          is_free = !held;
        }
    if (is_free) {
      EXPECT_EQ(found.solid.answer, Answer::Refuted) << i;
    }
    (found.solid.answer == Answer::Refuted ? voids : none) += 1;
    EXPECT_NE(found.solid.answer, Answer::Undecided) << i;
  }
  EXPECT_GT(voids, 20);
  EXPECT_GT(none, 20);
}

TEST(BallCover, AnyScaleAndPlace) {
  for (const double scale : {0x1p-400, 1e-30, 1e-9, 1e9, 1e60}) {
    Mesh original = cube(1);
    for (Vec3& v : original.vertices) v *= scale;
    for (const bool large : {true, false}) {
      ConvexSet set;
      for (const Vec3& v : original.vertices) add_ball(set, v, scale * (large ? 1.8 : 1.6));
      const Inclusion found = verify_ball_cover(original, set);
      EXPECT_EQ(found.surface.answer, Answer::Verified) << scale;
      EXPECT_EQ(found.solid.answer, large ? Answer::Verified : Answer::Refuted) << scale;
    }
  }
}

TEST(BallCover, OpenMeshesHaveNoSolid) {
  Mesh open = cube(1);
  open.triangles.pop_back();
  ConvexSet set;
  add_ball(set, {0, 0, 0}, 2);
  const Inclusion found = verify_ball_cover(open, set);
  EXPECT_EQ(found.surface.answer, Answer::Verified);
  EXPECT_EQ(found.solid.answer, Answer::Undefined);
  EXPECT_EQ(verify_ball_cover({}, set).surface.answer, Answer::Undefined);
}

TEST(BallCover, ExcessIsThatOfTheFarthestPoint) {
  const Mesh original = cube(1);
  ConvexSet set;
  add_ball(set, {0, 0, 0}, 1.5);        // 0.5 beyond each face
  add_ball(set, {0.9, 0.9, 0.9}, 0.4);  // (0.9 + 0.4) − 1 beyond faces, at the corner less
  const auto answer = [&](double epsilon) {
    return verify_excess(set, original, epsilon, true).answer;
  };
  EXPECT_EQ(answer(0.5 * (1 + 1e-9)), Answer::Verified);
  EXPECT_EQ(answer(0.5 * (1 - 1e-6)), Answer::Refuted);
  // A ball that fills a notch: nowhere farther than half of what its radius and centre say.
  Mesh walls = box_of({-3, -3, -3}, {-1, 3, 3});
  add(walls, box_of({1, -3, -3}, {3, 3, 3}), false);
  set.bodies.clear();
  add_ball(set, {0, 0, 0}, 1.5);  // centre 1 from both: 1 is the most, not 1 + 1.5
  EXPECT_EQ(verify_excess(set, walls, 1.02, true).answer, Answer::Verified);
  const DistanceClaim less = verify_excess(set, walls, 0.98, true);
  EXPECT_EQ(less.answer, Answer::Refuted);
  EXPECT_GT(less.largest, 0.98);
  EXPECT_LE(less.largest, 1);
}

// Balls that touch what is just within ε along circles, in solids with walls inside.
TEST(BallCover, ExcessIsDecidedWhereWallsAreInside) {
  Mesh beam = box_of({0, 0, 0}, {2, 1, 1});
  add(beam, box_of({1, 0, 0}, {3, 1, 1}), false);
  ConvexSet set;
  add_ball(set, {1.5, 0.5, 0.5}, 0.6);
  add_ball(set, {0.9, 0.5, 0.5}, 0.6);  // its nearest triangle is a wall inside
  const auto answer = [&](const Mesh& solid, double epsilon) {
    return verify_excess(set, solid, epsilon, true).answer;
  };
  EXPECT_EQ(answer(beam, 0.1 * (1 + 1e-5)), Answer::Verified);
  EXPECT_NE(answer(beam, 0.1 * (1 - 1e-9)), Answer::Verified);
  EXPECT_EQ(answer(beam, 0.099), Answer::Refuted);
  // A prism of sixteen sides, which balls touch at sixteen edges.
  std::vector<Vec3> corners;
  for (int i = 0; i < 16; ++i)
    for (const double z : {-2.0, 0.5, -0.5, 2.0})
      corners.emplace_back(std::cos(i * M_PI / 8), std::sin(i * M_PI / 8), z);
  Mesh rod = *geom::convex_hull(corners);
  add(rod, box_of({-0.2, -0.2, -0.1}, {0.2, 0.2, 0.1}), false);  // winds twice
  set.bodies.clear();
  add_ball(set, {0, 0, 0}, 1.25);
  const double known = 1.25 - std::cos(M_PI / 16);
  EXPECT_EQ(answer(rod, known * (1 + 1e-5)), Answer::Verified);
  EXPECT_NE(answer(rod, known * (1 - 1e-9)), Answer::Verified);
}

// Random balls at random solids: never verified where a point is known to be farther, always where
// ε is a little more than any that was found.
TEST(BallCover, ExcessAgreesWithPoints) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int turn = 0; turn < 20; ++turn) {
    std::vector<std::pair<Vec3, Vec3>> boxes;
    Mesh solid;
    for (int i = 0; i < 3; ++i) {
      const Vec3 at(number(random), number(random), number(random));
      const Vec3 size(0.8 + 0.5 * number(random), 0.8 + 0.5 * number(random), 0.5);
      boxes.emplace_back(at - size, at + size);
      add(solid, box_of(at - size, at + size), false);
    }
    const auto distance = [&](const Vec3& p) {  // from the union of boxes
      double out = HUGE_VAL;
      for (const auto& [low, high] : boxes)
        out = std::min(out, (low - p).cwiseMax(p - high).cwiseMax(0.0).norm());
      return out;
    };
    ConvexSet set;
    const Vec3 c = 0.7 * Vec3(number(random), number(random), number(random));
    const double radius = 1 + 0.5 * number(random);
    add_ball(set, c, radius);
    double most = 0;
    for (int k = 0; k < 40000; ++k) {
      const Vec3 d(number(random), number(random), number(random));
      if (d.norm() > 0.1)
        most = std::max(most, distance(c + radius * (1 - 1e-12) * d.normalized()));
    }
    if (most < 0.05) continue;
    EXPECT_NE(verify_excess(set, solid, most * (1 - 1e-9), true).answer, Answer::Verified) << turn;
    EXPECT_EQ(verify_excess(set, solid, most * 1.02 + 0.002, true).answer, Answer::Verified)
        << turn;
  }
}

// Hundreds of balls: the judge of whole robots.
TEST(BallCover, ManyBalls) {
  const Mesh original = cube(1);
  ConvexSet set;
  constexpr int kSide = 9;
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z) {
        const Vec3 c = 2.0 / kSide * Vec3(x + 0.5, y + 0.5, z + 0.5) - Vec3::Ones();
        add_ball(set, c, 1.0 / kSide * 1.74);  // √3 is 1.7320
      }
  const Inclusion found = verify_ball_cover(original, set);
  EXPECT_EQ(found.surface.answer, Answer::Verified);
  EXPECT_EQ(found.solid.answer, Answer::Verified);
  set.bodies[kSide * kSide * kSide / 2].radius *= 0.98;  // the middle: its corners are lost
  EXPECT_EQ(verify_ball_cover(original, set).surface.answer, Answer::Verified);
  EXPECT_EQ(verify_ball_cover(original, set).solid.answer, Answer::Verified)
      << "its neighbours hold the corners";
  set.bodies[kSide * kSide * kSide / 2].radius = 0.001;
  EXPECT_EQ(verify_ball_cover(original, set).solid.answer, Answer::Refuted);
}

// Parts for pictures: all of the area, and outside no more and no less than what is measured.
TEST(BallCover, SplitPartsAddUp) {
  const Mesh original = cube(1);
  ConvexSet set;
  add_ball(set, Vec3(0.2, 0.1, 0), 1.3);
  const auto area_of = [](const Mesh& mesh) {
    double out = 0;
    for (const auto& [i, j, k] : mesh.triangles)
      out +=
          0.5 *
          (mesh.vertices[j] - mesh.vertices[i]).cross(mesh.vertices[k] - mesh.vertices[i]).norm();
    return out;
  };
  const OutsideBalls measured = measure_outside_balls(original, set);
  const SplitMesh parts = split_by_balls(original, set, 0.02, 100'000);
  EXPECT_NEAR(area_of(parts.held) + area_of(parts.outside), measured.area, 1e-9);
  EXPECT_NEAR(area_of(parts.outside) / measured.area, measured.share_lower, 0.01);
  EXPECT_GT(measured.share_lower, 0.1);
  EXPECT_EQ(split_by_balls(original, {}, 0.1, 1000).outside.triangles.size(),
            original.triangles.size());
  EXPECT_TRUE(split_by_balls(original, {}, 0.1, 1000).held.triangles.empty());
}

}  // namespace
}  // namespace ball_cover_test
}  // namespace kaboum::verify
