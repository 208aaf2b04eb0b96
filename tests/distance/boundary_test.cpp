#include <kaboum/distance/boundary.h>

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace {

using kaboum::distance::union_boundary;
using kaboum::geom::ConvexSet;
using kaboum::geom::Mesh;
using kaboum::geom::Vec3;

ConvexSet bodies_of(const std::vector<Mesh>& bodies) {
  ConvexSet set;
  for (const Mesh& body : bodies)
    set.bodies.push_back({"body " + std::to_string(set.bodies.size()), body});
  return set;
}

double area(const ConvexSet& set) { return kaboum::geom::area(union_boundary(set).mesh); }

TEST(UnionBoundary, OfBoxes) {
  const Mesh box = kaboum::test::box({1, 1, 1}, 2);
  const auto at = [&](double x, double y, double z) {
    return kaboum::test::translated(box, {x, y, z});
  };
  EXPECT_NEAR(area(bodies_of({box})), 6, 1e-12);
  EXPECT_NEAR(area(bodies_of({box, at(3, 0, 0)})), 12, 1e-12);
  EXPECT_NEAR(area(bodies_of({box, at(0.5, 0, 0)})), 8, 1e-12);  // coplanar sides count once
  EXPECT_NEAR(area(bodies_of({box, at(0.5, 0.5, 0.5)})), 10.5, 1e-12);
  EXPECT_NEAR(area(bodies_of({box, at(1, 0, 0)})), 10, 1e-12);       // shared face
  EXPECT_NEAR(area(bodies_of({box, at(1, 0.25, 0)})), 10.5, 1e-12);  // part of a face shared
  EXPECT_NEAR(area(bodies_of({box, at(1, 1, 0)})), 12, 1e-12);       // shared edge
  EXPECT_NEAR(area(bodies_of({box, box})), 6, 1e-12);
  EXPECT_NEAR(area(bodies_of({box, box, at(1, 0, 0), at(0.5, 0, 0)})), 10, 1e-12);
  EXPECT_NEAR(area(bodies_of({kaboum::test::scaled(box, {3, 3, 3}), at(1, 1, 1)})), 54, 1e-12);
}

// No point of the boundary lies inside a body; points of facets outside all other bodies are kept.
TEST(UnionBoundary, OfRandomHulls) {
  for (std::uint32_t seed = 1; seed < 6; ++seed) {
    std::vector<Mesh> bodies;
    for (std::uint32_t i = 0; i < 4; ++i)
      bodies.push_back(kaboum::test::translated(
          kaboum::test::random_hull(20, kaboum::test::Cloud::Sphere, 10 * seed + i),
          {0.4 * i, 0.1 * i, 0}));
    const auto boundary = union_boundary(bodies_of(bodies));
    EXPECT_LT(boundary.error, 1e-14);
    const auto height = [](const Mesh& body, const Vec3& p) {
      double largest = -1e300;
      for (const auto& [i, j, k] : body.triangles) {
        const Vec3 n = (body.vertices[j] - body.vertices[i])
                           .cross(body.vertices[k] - body.vertices[i])
                           .normalized();
        largest = std::max(largest, n.dot(p - body.vertices[i]));
      }
      return largest;
    };
    for (const auto& [i, j, k] : boundary.mesh.triangles) {
      const auto& v = boundary.mesh.vertices;
      for (const Vec3& p : {Vec3((v[i] + v[j] + v[k]) / 3), v[i]})
        for (const Mesh& body : bodies) EXPECT_GT(height(body, p), -1e-12);
    }
    // Areas: what is kept of each body is what lies outside the others, by counting points.
    double outside = 0, total = 0;
    for (const Mesh& body : bodies) {
      for (const auto& [i, j, k] : body.triangles) {
        const Vec3 &a = body.vertices[i], &b = body.vertices[j], &c = body.vertices[k];
        const double part = 0.5 * (b - a).cross(c - a).norm();
        total += part;
        constexpr int kSteps = 40;
        int count = 0, kept = 0;
        for (int s = 0; s < kSteps; ++s)
          for (int t = 0; s + t < kSteps; ++t) {
            const Vec3 p =
                a + ((s + 1.0 / 3) / kSteps) * (b - a) + ((t + 1.0 / 3) / kSteps) * (c - a);
            ++count;
            bool inside = false;
            for (const Mesh& other : bodies)
              inside = inside || (&other != &body && height(other, p) < 0);
            kept += inside ? 0 : 1;
          }
        outside += part * kept / count;
      }
    }
    EXPECT_NEAR(kaboum::geom::area(boundary.mesh), outside, 0.01 * total) << seed;
  }
}

TEST(UnionBoundary, RefusesWhatIsNotConvex) {
  EXPECT_ANY_THROW(union_boundary(bodies_of({kaboum::test::torus(1, 0.3, 12, 8)})));
}

}  // namespace
