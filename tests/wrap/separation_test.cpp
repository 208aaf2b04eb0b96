// Tetrahedra that are said to be clear of triangles, against points of both.
#include <gtest/gtest.h>
#include <kaboum/base/random.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "obstacle.h"

namespace kaboum::wrap {
namespace {

using geom::Mesh;

Vec3 random_point(Random& random, double size) {
  const double x = random.between(-size, size), y = random.between(-size, size),
               z = random.between(-size, size);
  return {x, y, z};
}

/// Where a tetrahedron is clear of a triangle, no convex combinations of both coincide: tried by
/// the nearest point to many points of the tetrahedron. Touching ones are never clear.
TEST(Obstacle, ClearTetrahedraHoldNoPointOfTheTriangle) {
  Random random(11);
  int clear = 0;
  for (int i = 0; i < 3000; ++i) {
    geom::Mesh mesh;
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(random_point(random, 1));
    mesh.triangles.push_back({0, 1, 2});
    const Obstacle obstacle(mesh);
    Tetrahedron t;
    for (Vec3& p : t) p = random_point(random, 1);
    // Every third tetrahedron has a corner on the triangle.
    if (i % 3 == 0) t[i % 4] = mesh.vertices[i % 3];
    const bool is_clear = obstacle.clear(std::span(&t, 1));
    if (i % 3 == 0) {
      EXPECT_FALSE(is_clear);
    }
    if (!is_clear) continue;
    ++clear;
    for (int n = 0; n < 50; ++n) {
      double u = random.between(0, 1), v = random.between(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3 p = mesh.vertices[0] + u * (mesh.vertices[1] - mesh.vertices[0]) +
                     v * (mesh.vertices[2] - mesh.vertices[0]);
      Eigen::Matrix3d m;
      for (int k = 0; k < 3; ++k) m.col(k) = t[k] - t[3];
      const Vec3 w = m.inverse() * (p - t[3]);
      EXPECT_FALSE((w.array() > 1e-9).all() && w.sum() < 1 - 1e-9);
    }
  }
  EXPECT_GT(clear, 300);
}

/// The squares of its normals' components are below the range of doubles.
TEST(Obstacle, ClearanceHoldsForTinyEdges) {
  for (const double tiny : {1e-120, 1e-150, 1e-160, 1e-165, 1e-200, 1e-300}) {
    geom::Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {tiny, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const Obstacle obstacle(mesh, 0.1);
    const Tetrahedron near{Vec3(0, 0.2, 0.01), Vec3(1, 0.2, 0.01), Vec3(0, 0.8, 0.01),
                           Vec3(0, 0.2, 1)},
        far{Vec3(0, 0.2, 0.2), Vec3(1, 0.2, 0.2), Vec3(0, 0.8, 0.2), Vec3(0, 0.2, 1)};
    EXPECT_FALSE(obstacle.clear(std::array<Tetrahedron, 1>{near})) << tiny;
    EXPECT_TRUE(obstacle.clear(std::array<Tetrahedron, 1>{far})) << tiny;
  }
}

/// Steps have many tetrahedra, and inputs many triangles, of which a few are tried in the end: what
/// is clear holds no point of any triangle, nor is nearer than the clearance to one.
TEST(Obstacle, ClearStepsHoldNoPointOfAnyTriangle) {
  Random random(29);
  int clear = 0, not_clear = 0;
  for (int i = 0; i < 2000; ++i) {
    geom::Mesh mesh;
    const double size = i % 3 == 0 ? 0.02 : 0.3;
    for (int t = 0; t < 40; ++t) {
      const Vec3 middle = random_point(random, 1);
      for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(middle + random_point(random, size));
      const auto first = static_cast<std::uint32_t>(3 * t);
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const double clearance = i % 2 == 0 ? 0 : 0.01;
    const Obstacle obstacle(mesh, clearance);
    const Vec3 p = random_point(random, 1);
    std::vector<Tetrahedron> step(static_cast<std::size_t>(1 + i % 9));
    for (Tetrahedron& t : step) {
      for (Vec3& corner : t) corner = p + random_point(random, 0.3);
      t[3] = p;
    }
    if (!obstacle.clear(step)) {
      ++not_clear;
      continue;
    }
    ++clear;
    for (const Tetrahedron& t : step) {
      for (int n = 0; n < 60; ++n) {
        std::array<double, 4> w;
        for (double& x : w) x = -std::log(random.between(1e-9, 1));
        const Vec3 q =
            (w[0] * t[0] + w[1] * t[1] + w[2] * t[2] + w[3] * t[3]) / (w[0] + w[1] + w[2] + w[3]);
        for (const auto& [a, b, c] : mesh.triangles)
          ASSERT_GT(
              geom::point_triangle_distance(q, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])
                  .upper,
              clearance);
      }
      for (const auto& c : mesh.triangles) {  // corners, edges and middles of the triangles
        for (int n = 0; n < 20; ++n) {
          double u = random.between(0, 1), v = n < 8 ? 0 : random.between(0, 1);
          if (u + v > 1) u = 1 - u, v = 1 - v;
          const Vec3& o = mesh.vertices[c[static_cast<std::size_t>(n % 3)]];
          const Vec3 q = o + u * (mesh.vertices[c[static_cast<std::size_t>((n + 1) % 3)]] - o) +
                         v * (mesh.vertices[c[static_cast<std::size_t>((n + 2) % 3)]] - o);
          Eigen::Matrix3d m;
          for (int k = 0; k < 3; ++k) m.col(k) = t[static_cast<std::size_t>(k)] - t[3];
          const Vec3 w = m.inverse() * (q - t[3]);
          ASSERT_FALSE((w.array() > 1e-9).all() && w.sum() < 1 - 1e-9);
        }
      }
    }
  }
  EXPECT_GT(clear, 300);
  EXPECT_GT(not_clear, 300);
}

/// A fan of needles from one tip: the hierarchy cuts them, its boxes hold parts.
Mesh needles() {
  Mesh mesh;
  for (int t = 0; t < 120; ++t) {
    const double h = 2 * std::numbers::pi * t / 120;
    mesh.vertices.insert(mesh.vertices.end(), {Vec3(0, 0, 0), Vec3(std::cos(h), std::sin(h), 1),
                                               Vec3(std::cos(h + 0.05), std::sin(h + 0.05), 1)});
    const auto first = static_cast<std::uint32_t>(3 * t);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Tetrahedra with a corner, an edge or a face that is parallel to a triangle, at a multiple of the
/// clearance above it, and all else beyond.
TEST(Obstacle, TheClearanceIsKeptExactly) {
  const Mesh fan = needles();
  EXPECT_GT(geom::DistanceQuery(fan).hierarchy().order().size(), fan.triangles.size());
  Random random(31);
  for (int i = 0; i < 3000; ++i) {
    Mesh mesh = fan;
    if (i % 3 != 0) {
      mesh = {};
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back(random_point(random, 1));
      if (i % 3 == 1)  // across an axis
        for (Vec3& v : mesh.vertices) v[i % 9 / 3] = 0.25;
      mesh.triangles = {{0, 1, 2}};
    }
    const geom::Triangle& t = mesh.triangles[random.index(mesh.triangles.size())];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double clearance = i % 2 == 0 ? 0.1 : 1e-4;
    const Obstacle obstacle(mesh, clearance);
    const Vec3 n = (b - a).cross(c - a).normalized() * (i % 4 < 2 ? 1 : -1);
    const double u = random.between(0.1, 0.5), v = random.between(0.1, 0.4);
    const Vec3 foot = a + u * (b - a) + v * (c - a);
    const double size = i % 5 == 0 ? 0.01 : 0.3;
    const auto beyond = [&] {
      const Vec3 d = random_point(random, size);
      return Vec3(d + (std::abs(d.dot(n)) - d.dot(n)) * n);
    };
    const auto beside = [&] {
      const Vec3 d = random_point(random, size);
      return Vec3(d - d.dot(n) * n);
    };
    const int kind = i / 3 % 4;  // what is parallel: a face, an edge, a corner; the last corner
    const Vec3 edge = beside();
    const std::array<Vec3, 4> from{kind < 2    ? edge
                                   : kind == 2 ? Vec3(0, 0, 0)
                                               : beyond(),
                                   kind < 2 ? Vec3(-edge) : beyond(),
                                   kind == 0 ? beside() : beyond(),
                                   kind == 3 ? Vec3(0, 0, 0) : beyond()};
    for (const double gap : {0.5, 0.9, 0.999, 1 - 1e-9, 1.01}) {
      if (gap > 1 && mesh.triangles.size() > 1) continue;  // another may be near
      Tetrahedron tetrahedron;
      for (std::size_t k = 0; k < 4; ++k) tetrahedron[k] = foot + gap * clearance * n + from[k];
      ASSERT_EQ(obstacle.clear(std::span(&tetrahedron, 1)), gap > 1) << i << ' ' << gap;
    }
  }
}

/// Where a corner is what is nearest, to a corner or an edge, a gap of little more than the
/// clearance is told, and one of less is not enough.
TEST(Obstacle, TheClearanceIsKeptExactlyAtCorners) {
  Random random(37);
  for (int i = 0; i < 2000; ++i) {
    const double clearance = i % 2 == 0 ? 0.1 : 1e-4;
    const Vec3 n = random_point(random, 1).normalized();
    const auto behind = [&](double sign) {  // strictly on one side of the plane across n
      const Vec3 d = random_point(random, 0.5);
      return Vec3(d + (sign * (std::abs(d.dot(n)) + 0.1) - d.dot(n)) * n);
    };
    const Vec3 foot = random_point(random, 1);
    Vec3 along = random_point(random, 0.5);
    along -= along.dot(n) * n;
    const int kind = i % 3;  // corner and corner; an edge of the triangle; one of the tetrahedron
    Mesh mesh;
    mesh.vertices = {foot, foot + behind(-1), foot + behind(-1)};
    if (kind == 1) {
      mesh.vertices[0] = foot + along;
      mesh.vertices[1] = foot - along;
    }
    mesh.triangles = {{0, 1, 2}};
    const Obstacle obstacle(mesh, clearance);
    for (const double gap : {0.9, 1 - 1e-9, 1 + 1e-6, 1.01}) {
      const Vec3 near = foot + gap * clearance * n;
      Tetrahedron t{near, near + behind(1), near + behind(1), near + behind(1)};
      if (kind == 2) {
        t[0] = near + along;
        t[1] = near - along;
      }
      std::swap(t[0], t[static_cast<std::size_t>(i / 3 % 4)]);
      ASSERT_EQ(obstacle.clear(std::span(&t, 1)), gap > 1) << i << ' ' << gap;
    }
  }
}

}  // namespace
}  // namespace kaboum::wrap
