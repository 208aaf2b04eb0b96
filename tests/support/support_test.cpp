// The generated meshes are what they claim to be; the oracle agrees with itself.
#include "support/families.h"
#include "support/oracle.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <cmath>
#include <set>

namespace kaboum::test {
namespace {

/// Whether a point near some triangle, on its inner side, has winding number ≥ 1.
bool finds_solid(const Mesh& mesh) {
  const std::size_t step = std::max<std::size_t>(1, mesh.triangles.size() / 40);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
    const auto& t = mesh.triangles[i];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 n = (b - a).cross(c - a);
    if (n.norm() == 0) continue;
    const Vec3 inner = (a + b + c) / 3 - 1e-6 * n / n.norm() * (b - a).norm();
    if (winding_number_slow(mesh, inner).value_or(0) >= 1) return true;
  }
  return false;
}

std::vector<Family> all_families() {
  std::vector<Family> all = closed_families();
  for (const auto& more : {open_families(), bad_families()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

TEST(Families, HaveTheirProperties) {
  for (const Family& f : all_families()) {
    SCOPED_TRACE(f.name);
    for (const auto& t : f.mesh.triangles) {
      for (const auto c : t) ASSERT_LT(c, f.mesh.vertices.size());
    }
    for (const Vec3& p : f.mesh.vertices) ASSERT_TRUE(p.allFinite());
    EXPECT_EQ(closed_chain(f.mesh), f.closed);
    if (f.closed) {
      EXPECT_EQ(finds_solid(f.mesh), f.solid);
    }
    if (f.solid) {
      EXPECT_EQ(exactly_convex(f.mesh), f.convex);
    }
  }
}

TEST(Families, SizesNamesAndPrecision) {
  std::set<std::string> names;
  for (const Family& f : all_families()) EXPECT_TRUE(names.insert(f.name).second) << f.name;
  int beyond_float = 0, all = 0;
  for (const auto& families : {closed_families(), open_families()}) {
    for (const Family& f : families) {
      EXPECT_GE(f.mesh.vertices.size(), 50U) << f.name;
      EXPECT_LE(f.mesh.vertices.size(), 5000U) << f.name;
      beyond_float += share_beyond_float(f.mesh) > 0.3 ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(2 * beyond_float, all);
}

TEST(Families, SameEveryTime) {
  const auto once = closed_families(), again = closed_families();
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].mesh.vertices, again[i].mesh.vertices);
    EXPECT_EQ(once[i].mesh.triangles, again[i].mesh.triangles);
  }
}

TEST(Families, SelfIntersectOnlyWhereMeant) {
  const std::set<std::string> crossing{"spheres-overlapping", "tube-self-crossing",
                                       "boxes-crossing-float", "component-twice-rotated"};
  const std::set<std::string> clean{
      "icosphere-2", "torus",           "knot-2-3", "knot-3-7",      "bracket-20",     "sphere-uv",
      "cavity",      "thin-plate-1e-5", "soup",     "solids-nested", "sliver-cylinder"};
  for (const Family& f : closed_families()) {
    if (crossing.count(f.name) + clean.count(f.name) == 0) continue;
    EXPECT_EQ(self_intersections(f.mesh) > 0, crossing.count(f.name) != 0) << f.name;
  }
}

TEST(Oracle, WindingNumbers) {
  const Mesh ball = icosphere(1);
  const auto at = [](const Mesh& mesh, double x, double y, double z) {
    return winding_number_slow(mesh, {x, y, z});
  };
  EXPECT_EQ(at(ball, 0, 0, 0), 1);
  EXPECT_EQ(at(ball, 2, 0, 0), 0);
  EXPECT_EQ(at(ball, 1e-300, 1e300, 0), 0);
  EXPECT_EQ(at(flipped(ball), 0.1, 0, 0), -1);
  EXPECT_EQ(at(merged({ball, scaled(ball, Vec3::Constant(0.5))}), 0.1, 0.2, 0), 2);
  EXPECT_EQ(at(merged({ball, flipped(scaled(ball, Vec3::Constant(0.5)))}), 0.1, 0.2, 0), 0);
  const Mesh cube = box({1, 1, 1}, 2);
  EXPECT_EQ(at(cube, 0.5, 0.5, 1), std::nullopt);   // on a vertex
  EXPECT_EQ(at(cube, 0.25, 0.5, 1), std::nullopt);  // on an edge
  EXPECT_EQ(at(cube, 0.3, 0.4, 1), std::nullopt);   // inside a triangle
  EXPECT_EQ(at(cube, 0.3, 0.4, std::nextafter(1.0, 0.0)), 1);
  EXPECT_EQ(at(cube, 0.3, 0.4, std::nextafter(1.0, 2.0)), 0);
  EXPECT_EQ(at(cube, 5, 5, 1), 0);  // in a face's plane
}

TEST(Oracle, ClosedChains) {
  EXPECT_TRUE(closed_chain(icosphere(1)));
  EXPECT_TRUE(closed_chain(soup(icosphere(1))));
  EXPECT_FALSE(closed_chain(moebius_strip(20, 2)));
  Mesh open = icosphere(1);
  open.triangles.pop_back();
  EXPECT_FALSE(closed_chain(open));
  EXPECT_TRUE(closed_manifold(icosphere(1)));
  EXPECT_FALSE(closed_manifold(open));
  const Mesh cube = box({1, 1, 1}, 2);
  EXPECT_FALSE(closed_manifold(merged({cube, translated(cube, {1, 1, 0})})));  // edge
  EXPECT_FALSE(closed_manifold(merged({cube, translated(cube, {1, 1, 1})})));  // vertex
}

TEST(Oracle, SelfIntersections) {
  const Mesh cube = box({1, 1, 1}, 1);
  EXPECT_EQ(self_intersections(cube), 0U);
  EXPECT_EQ(self_intersections(merged({cube, translated(cube, {1.5, 0, 0})})), 0U);
  EXPECT_GT(self_intersections(merged({cube, translated(cube, {0.5, 0.25, 0.25})})), 0U);
  EXPECT_GT(self_intersections(merged({cube, translated(cube, {1, 0.5, 0.5})})),
            0U);                                                                     // faces touch
  EXPECT_GT(self_intersections(merged({cube, translated(cube, {0.5, 0, 0})})), 0U);  // coplanar
  EXPECT_EQ(self_intersections(merged({cube, translated(cube, {1, 1, 1})})), 0U);  // common vertex
}

TEST(Hull, ContainsItsPoints) {
  for (const Cloud cloud : {Cloud::Ball, Cloud::Cube, Cloud::Sphere}) {
    const Mesh hull = random_hull(120, cloud, 7);
    EXPECT_TRUE(exactly_convex(hull));
    EXPECT_TRUE(closed_manifold(hull));
  }
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace kaboum::test
