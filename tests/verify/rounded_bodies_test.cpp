// Sets of bodies with radii of their own, and with segments and points as cores: membership against
// rational distances by CGAL, covers against points, and mutants of what is said of them.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <gtest/gtest.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/holding.h>
#include <kaboum/verify/mesh_verdict.h>
#include <kaboum/verify/sweep.h>

#include <cmath>
#include <random>

#include "body_bounds.h"
#include "support/shapes.h"

namespace kaboum::verify {
namespace {

using geom::ConvexBody;
using geom::ConvexSet;
using geom::Mesh;
using geom::Vec3;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;

Mesh cube(double half) {
  std::vector<Vec3> corners;
  for (const double x : {-half, half})
    for (const double y : {-half, half})
      for (const double z : {-half, half}) corners.emplace_back(x, y, z);
  return *geom::convex_hull(corners);
}

ConvexSet set_of(std::vector<ConvexBody> bodies) {
  ConvexSet set;
  set.bodies = std::move(bodies);
  return set;
}

ConvexBody ball(const Vec3& center, double radius) { return {"ball", {{center}, {}}, radius}; }
ConvexBody capsule(const Vec3& a, const Vec3& b, double radius) {
  return {"capsule", {{a, b}, {}}, radius};
}

/// The squared distance to a body's core by CGAL, exact.
Kernel::FT squared_distance(const ConvexBody& body, const Vec3& p) {
  const auto point = [](const Vec3& q) { return Kernel::Point_3(q.x(), q.y(), q.z()); };
  const std::vector<Vec3>& v = body.core.vertices;
  const Kernel::Point_3 at = point(p);
  if (body.core.triangles.empty()) {
    if (v.size() == 1) return CGAL::squared_distance(at, point(v[0]));
    return CGAL::squared_distance(at, Kernel::Segment_3(point(v[0]), point(v[1])));
  }
  bool inside = true;
  std::optional<Kernel::FT> least;
  for (const auto& [i, j, k] : body.core.triangles) {
    const Kernel::Triangle_3 t(point(v[i]), point(v[j]), point(v[k]));
    inside = inside && CGAL::orientation(t[0], t[1], t[2], at) != CGAL::POSITIVE;
    const Kernel::FT d = CGAL::squared_distance(at, t);
    if (!least || d < *least) least = d;
  }
  return inside ? Kernel::FT(0) : *least;
}

bool oracle_contains(const ConvexBody& body, const Vec3& p) {
  return squared_distance(body, p) <= Kernel::FT(body.radius) * Kernel::FT(body.radius);
}

/// Small whole numbers, so that points lie exactly on surfaces, too.
class Lattice {
 public:
  explicit Lattice(unsigned seed) : random_(seed) {}
  Vec3 point(int most) {
    std::uniform_int_distribution<int> of(-most, most);
    const int x = of(random_), y = of(random_), z = of(random_);
    return Vec3(x, y, z);
  }
  double radius() { return std::uniform_int_distribution<int>(1, 5)(random_); }
  ConvexBody body() {
    const double r = radius();
    switch (std::uniform_int_distribution<int>(0, 2)(random_)) {
      case 0:
        return ball(point(4), r);
      case 1: {
        const Vec3 a = point(4);
        Vec3 b = point(4);
        while (b == a) b = point(4);
        return capsule(a, b, r);
      }
      default:
        for (;;) {
          std::vector<Vec3> points;
          for (int i = 0; i < 6; ++i) points.push_back(point(4));
          if (auto hull = geom::convex_hull(points)) return {"rounded", *hull, r};
        }
    }
  }
  double real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  std::mt19937 random_;
};

TEST(RoundedBodies, MembershipIsExact) {
  Lattice lattice(1);
  int on = 0, in = 0, out = 0;
  for (int i = 0; i < 20'000; ++i) {
    const ConvexBody body = lattice.body();
    ASSERT_TRUE(geom::is_convex(body));
    const Vec3 p = lattice.point(6);
    const Kernel::FT square = squared_distance(body, p);
    const Kernel::FT radius(body.radius);
    EXPECT_EQ(contains(body, p), square <= radius * radius) << i;
    on += square == radius * radius ? 1 : 0;
    (square <= radius * radius ? in : out) += 1;
  }
  EXPECT_GT(on, 100);
  EXPECT_GT(in, 3000);
  EXPECT_GT(out, 3000);
}

TEST(RoundedBodies, MembershipIsExactByOneUlp) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  int different = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = any();
    for (ConvexBody body :
         {ball(any(), 1), capsule(any(), any(), 1),
          ConvexBody{"rounded", *geom::convex_hull(std::vector{any(), any(), any(), any()}), 1}}) {
      const double distance = std::sqrt(CGAL::to_double(squared_distance(body, p)));
      if (distance == 0) continue;
      bool before = false;
      body.radius = distance;
      for (int k = 0; k < 4; ++k) body.radius = std::nextafter(body.radius, 0);
      for (int k = 0; k < 9; ++k, body.radius = std::nextafter(body.radius, 1e9)) {
        EXPECT_EQ(contains(body, p), oracle_contains(body, p)) << i;
        different += k > 0 && before != contains(body, p) ? 1 : 0;
        before = contains(body, p);
      }
    }
  }
  EXPECT_GT(different, 700) << "the distance was hardly ever met";
}

TEST(RoundedBodies, ConvexityKnowsWhatACoreMayBe) {
  const auto fault = [](const ConvexBody& body) {
    EXPECT_EQ(geom::is_convex(body),
              verify_convexity(set_of({body})).convex.answer == Answer::Verified);
    const Convexity found = verify_convexity(set_of({body}));
    return found.not_convex.empty() ? std::string() : found.not_convex[0].second;
  };
  EXPECT_EQ(fault(ball({0, 0, 0}, 1)), "");
  EXPECT_EQ(fault(capsule({0, 0, 0}, {0, 0, 1}, 1)), "");
  EXPECT_EQ(fault({"", cube(1), 0.5}), "");
  EXPECT_NE(fault(ball({0, 0, 0}, 0)), "");
  EXPECT_NE(fault(ball({0, 0, 0}, -1)), "");
  EXPECT_NE(fault(ball({0, 0, 0}, std::nan(""))), "");
  EXPECT_NE(fault(ball({0, 0, 0}, INFINITY)), "");
  EXPECT_NE(fault(capsule({1, 0, 0}, {1, 0, 0}, 1)), "");
  EXPECT_NE(fault({"", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}}, 1}), "");
  EXPECT_NE(fault({"", {}, 1}), "");
  Mesh open = cube(1);
  open.triangles.pop_back();
  EXPECT_NE(fault({"", open, 1}), "");
}

TEST(RoundedBodies, BoundsAreInsideAndOutside) {
  Lattice lattice(3);
  for (int i = 0; i < 20; ++i) {
    const ConvexSet set = set_of({lattice.body()});
    double before = 100;
    for (int level = kFirstBoundsLevel; level <= kLastBoundsLevel - 1; ++level) {
      const auto bounds = bounds_of(set, level);
      ASSERT_TRUE(bounds);
      for (const Vec3& p : bounds->inside.bodies.at(0).core.vertices)
        EXPECT_TRUE(oracle_contains(set.bodies[0], p));
      EXPECT_LT(bounds->gap, 0.5 * before);
      before = bounds->gap;
      // Points of the body near its surface, in all directions, are in the outer polytope.
      ConvexBody larger = set.bodies[0];
      larger.radius += 1.001 * bounds->gap;
      for (const Vec3& p : bounds->outside.bodies.at(0).core.vertices)
        EXPECT_TRUE(oracle_contains(larger, p));
      const geom::SpherePoints sphere = geom::sphere_points(1);
      const Mesh& outer = bounds->outside.bodies[0].core;
      for (const Vec3& v : set.bodies[0].core.vertices)
        for (const Vec3& q : sphere.points)
          for (const auto& [a, b, c] : outer.triangles)
            EXPECT_NE(geom::orient3d(outer.vertices[a], outer.vertices[b], outer.vertices[c],
                                     v + set.bodies[0].radius * (1 - 1e-12) * q),
                      geom::Sign::Positive);
    }
  }
}

Answer cover_answer(const Mesh& original, const ConvexSet& set) {
  const Inclusion found = verify_cover(original, set).inclusion;
  return worse(found.solid.answer, found.surface.answer);
}

TEST(RoundedBodies, ABallCoversACubeFromItsCornersOn) {
  const Mesh original = cube(1);
  // √3 rounded up covers, decided at the corners exactly; one ulp less does not.
  const double least = std::nextafter(std::sqrt(3.0), 2);
  const bool up = oracle_contains(ball({0, 0, 0}, std::sqrt(3.0)), {1, 1, 1});
  const double covers = up ? std::sqrt(3.0) : least;
  EXPECT_EQ(cover_answer(original, set_of({ball({0, 0, 0}, covers)})), Answer::Verified);
  const Inclusion less =
      verify_cover(original, set_of({ball({0, 0, 0}, std::nextafter(covers, 0))})).inclusion;
  EXPECT_EQ(less.surface.answer, Answer::Refuted);
  ASSERT_TRUE(less.surface.witness);
  EXPECT_TRUE(less.surface.witness->exact);
  EXPECT_EQ(cover_answer(original, set_of({ball({0, 0, 0}, 1.5)})), Answer::Refuted);
  EXPECT_EQ(cover_answer(original, set_of({ball({0, 0, 0}, 2)})), Answer::Verified);
  EXPECT_EQ(cover_answer(original, set_of({capsule({-1, 0, 0}, {1, 0, 0}, 1.4)})), Answer::Refuted);
  EXPECT_EQ(cover_answer(original, set_of({capsule({-1, 0, 0}, {1, 0, 0}, 1.415)})),
            Answer::Verified);
  // Not every body is the same: polytopes, enlarged or not, among balls.
  const ConvexSet mixed = set_of({{"box", cube(0.75), 0}, {"wide", cube(0.75), 0.45}});
  EXPECT_EQ(cover_answer(original, mixed), Answer::Verified);
  const ConvexSet small = set_of({{"box", cube(0.75), 0}, {"wide", cube(0.75), 0.43}});
  EXPECT_EQ(cover_answer(original, small), Answer::Refuted);
}

TEST(RoundedBodies, AVoidBetweenBallsIsFound) {
  // Eight balls hold the faces of the cube, and leave its middle free.
  const Mesh original = cube(1);
  std::vector<ConvexBody> bodies;
  for (const Vec3& p : original.vertices) bodies.push_back(ball(p, 1.45));
  for (const bool filled : {false, true}) {
    if (filled) bodies.push_back(ball({0, 0, 0}, 0.7));
    const Inclusion found = verify_cover(original, set_of(bodies)).inclusion;
    EXPECT_EQ(found.surface.answer, Answer::Verified) << filled;
    EXPECT_EQ(found.solid.answer, filled ? Answer::Verified : Answer::Refuted);
  }
}

TEST(RoundedBodies, CoversAgreeWithPoints) {
  Lattice lattice(4);
  int verified = 0, refuted = 0;
  for (int i = 0; i < 60; ++i) {
    const Mesh original =
        *geom::convex_hull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    std::vector<ConvexBody> bodies;
    for (int k = 0; k < 3; ++k) {
      const auto any = [&] {
        const double x = lattice.real(0, 0.6), y = lattice.real(0, 0.6), z = lattice.real(0, 0.6);
        return Vec3(x, y, z);
      };
      const double radius = lattice.real(0.3, 1);
      bodies.push_back(k == 0 ? ball(any(), radius) : capsule(any(), any(), radius));
    }
    const ConvexSet set = set_of(bodies);
    const Answer answer = cover_answer(original, set);
    bool outside = false;
    for (int k = 0; k < 3000; ++k) {
      double w[4], sum = 0;
      for (double& x : w) sum += x = -std::log(lattice.real(1e-12, 1));
      Vec3 p = Vec3::Zero();
      for (int v = 0; v < 4; ++v) p += w[v] / sum * original.vertices[v];
      outside = outside || std::ranges::none_of(
                               bodies, [&](const ConvexBody& body) { return contains(body, p); });
    }
    EXPECT_FALSE(outside && answer == Answer::Verified) << i;
    verified += answer == Answer::Verified ? 1 : 0;
    refuted += answer == Answer::Refuted ? 1 : 0;
  }
  EXPECT_GT(verified, 5);
  EXPECT_GT(refuted, 5);
  EXPECT_GT(verified + refuted, 55) << "too much is left open";
}

TEST(RoundedBodies, ExcessIsThatOfTheBodies) {
  const Mesh original = cube(0.5);
  // The farthest point is on an axis: 1 − 0.5, though the core is 0 away.
  const ConvexSet set = set_of({ball({0, 0, 0}, 1), {"box", cube(0.5), 0}});
  EXPECT_EQ(verify_excess(set, original, 0.502, true).answer, Answer::Verified);
  EXPECT_EQ(verify_excess(set, original, 0.498, true).answer, Answer::Refuted);
  EXPECT_EQ(verify_excess(set, original, 0.5, true).answer, Answer::Undecided);
}

// Of an open original the bodies' surfaces count: those of a ball about a point of a plate.
TEST(RoundedBodies, ExcessOverAnOpenOriginalIsThatOfTheSurfaces) {
  Mesh plate;
  plate.vertices = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
  plate.triangles = {{0, 1, 2}};
  const ConvexSet set = set_of({ball({0, -3, 0}, 1), ball({0, -3, 0}, 0.5)});
  EXPECT_EQ(verify_excess(set, plate, 1.005, false).answer, Answer::Verified);
  EXPECT_EQ(verify_excess(set, plate, 0.995, false).answer, Answer::Refuted);
  // Nearer than any level's gap: never a guess.
  EXPECT_EQ(verify_excess(set, plate, 1.0001, false).answer, Answer::Undecided);
  EXPECT_EQ(verify_excess(set, plate, 0.9999, false).answer, Answer::Undecided);
}

TEST(RoundedBodies, InnerSetsLieInTheirSolid) {
  const Mesh original = cube(1);
  const auto within = [&](const ConvexBody& body) {
    const Inclusion found = verify_within(set_of({body}), original);
    return worse(found.solid.answer, found.surface.answer);
  };
  EXPECT_EQ(within(ball({0, 0, 0}, 0.998)), Answer::Verified);
  EXPECT_EQ(within(ball({0, 0, 0}, 1.002)), Answer::Refuted);
  EXPECT_EQ(within({"wide", cube(0.5), 0.498}), Answer::Verified);
  EXPECT_EQ(within({"wide", cube(0.5), 0.502}), Answer::Refuted);
  // The corners are √3 − 1 from the ball, and (1 − 1/√3) · 1 deep … the deepest point left out of
  // a ball of radius r on a diagonal is 1 − r/√3 deep.
  const ConvexSet set = set_of({ball({0, 0, 0}, 0.9)});
  const double depth = 1 - 0.9 / std::sqrt(3.0);
  EXPECT_EQ(verify_depth(original, set, depth + 0.01).answer, Answer::Verified);
  EXPECT_EQ(verify_depth(original, set, depth - 0.01).answer, Answer::Refuted);
}

TEST(RoundedBodies, AVerdictIsThatOfItsClaims) {
  const Mesh original = cube(1);
  const auto verdict = [&](const ConvexSet& set, Relation relation, double bound) {
    const Mesh sum = sum_of(set);
    return decide({original, sum, &set, relation, Claims::All, bound});
  };
  const MeshVerdict covers =
      verdict(set_of({ball({0, 0, 0}, 1.8), {"box", cube(1), 0}}), Relation::Cover, 0.81);
  EXPECT_EQ(covers.answer, Answer::Verified);
  const MeshVerdict misses = verdict(
      set_of({ball({0, 0, 0}, 1.2), capsule({0, 0, -1}, {0, 0, 1}, 0.5)}), Relation::Cover, 0.81);
  EXPECT_EQ(misses.answer, Answer::Refuted);
  ASSERT_TRUE(misses.surface_depth);
  const double depth = std::sqrt(3.0) - 1.2;  // at the corners, but for the capsule's ends
  EXPECT_LE(misses.surface_depth->lower, depth);
  EXPECT_GE(misses.surface_depth->upper, depth);
  EXPECT_LT(misses.surface_depth->upper, depth + 0.05);
  const MeshVerdict inner =
      verdict(set_of({ball({0, 0, 0}, 0.9), {"box", cube(0.9), 0}}), Relation::Inner, 0.11);
  EXPECT_EQ(inner.answer, Answer::Verified);
  EXPECT_EQ(
      verdict(set_of({ball({0, 0, 0}, 0.9), ball({0, 0, 0.2}, 0.9)}), Relation::Inner, 0.9).answer,
      Answer::Refuted);
}

// What was uniform before takes the way it took, and says what it said.
TEST(RoundedBodies, OneRadiusIsAMargin) {
  ConvexSet set = set_of({{"a", cube(1), 0.25}, {"b", cube(2), 0.25}});
  EXPECT_EQ(geom::margin_of(set), 0.25);
  set.bodies[1].radius = 0.5;
  EXPECT_EQ(geom::margin_of(set), std::nullopt);
  EXPECT_EQ(geom::margin_of(set_of({ball({0, 0, 0}, 1)})), std::nullopt);
  EXPECT_EQ(geom::margin_of({}), 0.0);
}

}  // namespace
}  // namespace kaboum::verify
