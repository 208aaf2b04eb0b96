// Points inside a solid or outside: exactly, and as far as their own rounding allows.
#include <kaboum/verify/cover.h>
#include <kaboum/verify/mesh_verdict.h>
#include <kaboum/verify/points.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/shapes.h"

namespace kaboum::verify {
namespace {

using geom::Mesh;
using geom::Vec3;

/// From corner to corner.
Mesh box_of(const Vec3& low, const Vec3& high) {
  return test::translated(test::box(high - low, 1), low);
}

PointClaim ask(const std::vector<Vec3>& points, const Mesh& solid, double rounding = 0,
               double margin = 0) {
  std::vector<std::uint32_t> faces(points.size());
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i] = static_cast<std::uint32_t>(i);
  return verify_points({points, faces, rounding}, solid, margin);
}

TEST(Points, InsideOnTheSurfaceAndOutside) {
  const Mesh box = box_of({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(ask({{0.5, 0.5, 0.5}, {1, 0.5, 0.5}, {1, 1, 1}, {0, 0.25, 1}}, box).answer,
            Answer::Verified);
  const PointClaim out = ask({{0.5, 0.5, 0.5}, {1.25, 0.5, 0.5}, {0.5, 0.5, 3}}, box);
  EXPECT_EQ(out.answer, Answer::Refuted);
  EXPECT_EQ(out.points, 3U);
  EXPECT_EQ(out.outside, 2U);
  EXPECT_EQ(out.faces, 2U);
  EXPECT_EQ(out.face, 2U);
  EXPECT_EQ(out.at, Vec3(0.5, 0.5, 3));
  EXPECT_LE(out.farthest, 2.0);
  EXPECT_GT(out.farthest, 2.0 - 1e-9);
}

TEST(Points, OneStepBeyondTheSurfaceIsOutsideUnlessItMayBeRounding) {
  const Mesh box = box_of({0, 0, 0}, {1, 1, 1});
  const double step = std::ldexp(1.0, -20);
  EXPECT_EQ(ask({{1 + step, 0.5, 0.5}}, box).answer, Answer::Refuted);
  EXPECT_EQ(ask({{1 + step, 0.5, 0.5}}, box, step).answer, Answer::Verified);
  EXPECT_EQ(ask({{1 + 4 * step, 0.5, 0.5}}, box, step).answer, Answer::Refuted);
}

TEST(Points, HollowsAreOutside) {
  Mesh hollow = box_of({0, 0, 0}, {3, 3, 3});
  const Mesh inner = box_of({1, 1, 1}, {2, 2, 2});
  const auto first = static_cast<std::uint32_t>(hollow.vertices.size());
  hollow.vertices.insert(hollow.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (const geom::Triangle& t : inner.triangles)
    hollow.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  const PointClaim out = ask({{1.5, 1.5, 1.25}, {0.5, 0.5, 0.5}}, hollow);
  EXPECT_EQ(out.outside, 1U);
  EXPECT_NEAR(out.farthest, 0.25, 1e-9);
}

TEST(Points, MarginsOfSetsCount) {
  const Mesh box = box_of({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(ask({{1.5, 0.5, 0.5}}, box, 0, 0.6).answer, Answer::Verified);
  const PointClaim out = ask({{1.5, 0.5, 0.5}}, box, 0, 0.4);
  EXPECT_EQ(out.answer, Answer::Refuted);
  EXPECT_NEAR(out.farthest, 0.1, 1e-9);
}

TEST(Points, AnySize) {
  for (const double size : {1e-280, 1e-30, 1e30, 1e280}) {
    const Mesh box = box_of({0, 0, 0}, {size, size, size});
    EXPECT_EQ(ask({{0.5 * size, size, 0.25 * size}}, box).answer, Answer::Verified) << size;
    EXPECT_EQ(ask({{0.5 * size, 1.5 * size, 0.25 * size}}, box).answer, Answer::Refuted) << size;
  }
  // Far beyond what the solid's size can be compared with.
  const Mesh tiny = box_of({0, 0, 0}, {1e-280, 1e-280, 1e-280});
  const PointClaim out = ask({{1e200, 0, 0}}, tiny);
  EXPECT_EQ(out.answer, Answer::Refuted);
  EXPECT_NEAR(out.farthest / 1e200, 1, 1e-9);
}

TEST(Points, NothingIsDecidedOfNothing) {
  const Mesh box = box_of({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(ask({}, box).answer, Answer::Undefined);
  Mesh open = box;
  open.triangles.pop_back();
  EXPECT_EQ(ask({{0.5, 0.5, 0.5}}, open).answer, Answer::Undefined);
}

TEST(Points, DecideTheVerdict) {
  // The triangles lie inside, the faces that they stand for do not.
  const Mesh original = box_of({0, 0, 0}, {1, 1, 1}), outer = box_of({0, 0, 0}, {2, 2, 2});
  const std::vector<Vec3> in{{1.5, 0.5, 0.5}}, out{{2.5, 0.5, 0.5}};
  const std::vector<std::uint32_t> face{0};
  MeshQuestion question{original, outer};
  EXPECT_EQ(decide(question).answer, Answer::Verified);
  question.exact_points = PointQuestion{in, face, 0};
  EXPECT_EQ(decide(question).answer, Answer::Verified);
  question.exact_points = PointQuestion{out, face, 0};
  const MeshVerdict verdict = decide(question);
  EXPECT_EQ(verdict.answer, Answer::Refuted);
  EXPECT_EQ(verdict.inclusion.surface.answer, Answer::Verified);
  ASSERT_TRUE(verdict.exact_points);
  EXPECT_EQ(verdict.exact_points->outside, 1U);
  // Of an inner approximation they say nothing.
  MeshQuestion inner{outer, original};
  inner.relation = Relation::Inner;
  inner.exact_points = PointQuestion{out, face, 0};
  EXPECT_FALSE(decide(inner).exact_points);
}

}  // namespace
}  // namespace kaboum::verify
