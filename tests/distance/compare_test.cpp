#include <kaboum/base/error.h>
#include <kaboum/distance/compare.h>
#include <kaboum/geom/convex_hull.h>

#include <gtest/gtest.h>

#include <limits>

#include "support/shapes.h"

namespace {

using kaboum::distance::Compared;
using kaboum::distance::CompareOptions;
using kaboum::distance::Comparison;
using kaboum::distance::Shape;
using kaboum::geom::Mesh;
using kaboum::geom::Vec3;

Mesh block(const Vec3& low, const Vec3& high) {
  return kaboum::test::translated(kaboum::test::box(high - low, 1), low);
}

Shape mesh(const Mesh& m) { return {"m", m, {}}; }

Shape set(const std::vector<Mesh>& hulls, double margin = 0) {
  kaboum::geom::ConvexSet s;
  for (const Mesh& hull : hulls) s.bodies.push_back({"body", hull});
  set_margin(s, margin);
  return {"s", {}, s};
}

CompareOptions few(bool solid) {
  CompareOptions o;
  o.solid = solid;
  o.samples = 1000;
  return o;
}

void expect_bracket(double lower, double upper, double truth) {
  EXPECT_LE(lower, truth);
  EXPECT_GE(upper, truth);
  EXPECT_NEAR(lower, truth, 2e-3 * truth + 1e-9);
  EXPECT_NEAR(upper, truth, 2e-3 * truth + 1e-9);
}

// A unit cube in the middle of one of side 3.
TEST(Compare, SurfacesAndSolidsOfNestedCubes) {
  const Mesh inner = block({1, 1, 1}, {2, 2, 2}), outer = block({0, 0, 0}, {3, 3, 3});
  const Compared surfaces = Comparison(mesh(inner), mesh(outer), few(false)).measure();
  expect_bracket(surfaces.a_to_b.max.max_lower, surfaces.a_to_b.max.max_upper, 1);
  expect_bracket(surfaces.b_to_a.max.max_lower, surfaces.b_to_a.max.max_upper, std::sqrt(3.0));
  expect_bracket(surfaces.min.lower, surfaces.min.upper, 1);
  const Compared solids = Comparison(mesh(inner), mesh(outer), few(true)).measure();
  EXPECT_EQ(solids.a_to_b.max.max_upper, 0);
  EXPECT_EQ(solids.min.upper, 0);
  expect_bracket(solids.lower(), solids.upper(), std::sqrt(3.0));
}

TEST(Compare, ASetCountsAsItsUnion) {
  const Shape halves = set({block({0, 0, 0}, {1, 2, 1}), block({1, 0, 0}, {2, 2, 1})});
  const Comparison c(halves, mesh(block({0, 0, 0}, {2, 2, 1})), few(false));
  const Compared same = c.measure();
  EXPECT_LE(same.upper(), 1e-6 + 2 * c.surface_error(Comparison::A));
  EXPECT_THROW(Comparison(set({block({0, 0, 0}, {1, 1, 1})}, 0.5), halves, few(false)),
               kaboum::Error);
  const Compared grown = Comparison(set({block({0, 0, 0}, {1, 1, 1})}, 0.5),
                                    mesh(block({0, 0, 0}, {1, 1, 1})), few(true))
                             .measure();
  expect_bracket(grown.lower(), grown.upper(), 0.5);
}

// Far away along one axis, by what can be subtracted exactly: the same brackets, moved points.
TEST(Compare, IsMovedToTheOrigin) {
  const Vec3 far(0x1p30, 0, 0);
  const Mesh a = block({1, 1, 1}, {2, 2, 2}), b = block({0, 0, 0}, {3, 3, 3});
  const Compared here = Comparison(mesh(a), mesh(b), few(false)).measure();
  const Comparison moved(mesh(kaboum::test::translated(a, far)),
                         mesh(kaboum::test::translated(b, far)), few(false));
  const Compared there = moved.measure();
  EXPECT_EQ(moved.origin(), far);
  EXPECT_EQ(here.lower(), there.lower());
  EXPECT_EQ(here.upper(), there.upper());
  EXPECT_EQ(Vec3(here.b_to_a.max.at + far), there.b_to_a.max.at);
  EXPECT_EQ(Vec3(here.min.on_a + far), there.min.on_a);
}

TEST(Compare, RefusesWhatHasNoDistance) {
  const Mesh good = block({0, 0, 0}, {1, 1, 1});
  Mesh bad = good;
  bad.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Comparison(mesh(bad), mesh(good), {}), kaboum::Error);
  bad.vertices[0].x() = -1e61;
  EXPECT_THROW(Comparison(mesh(bad), mesh(good), {}), kaboum::Error);
  EXPECT_THROW(Comparison(mesh({}), mesh(good), {}), kaboum::Error);
  EXPECT_THROW(Comparison(set({}), mesh(good), {}), kaboum::Error);
}

}  // namespace
