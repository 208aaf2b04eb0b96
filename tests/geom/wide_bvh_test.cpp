/// The hierarchy of four boxes at a time against all triangles one by one.
#include <gtest/gtest.h>
#include <kaboum/geom/closest_point.h>
#include <kaboum/geom/wide_bvh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace kaboum::geom {
namespace {

/// Triangles of all sizes about the origin, some of them slivers, some points.
Mesh soup(std::mt19937_64& random, int count, double size) {
  std::normal_distribution<double> number;
  Mesh out;
  for (int i = 0; i < count; ++i) {
    const Vec3 at(number(random), number(random), number(random));
    const auto base = static_cast<std::uint32_t>(out.vertices.size());
    for (int k = 0; k < 3; ++k) {
      const double spread = i % 7 == 0 ? 1e-9 * k : 0.2 * number(random);
      out.vertices.emplace_back(size * (at + spread * Vec3(1, i % 5 == 0 ? 0 : k, number(random))));
    }
    out.triangles.push_back({base, base + 1, base + 2});
  }
  return out;
}

double nearest(const Mesh& mesh, const Bvh& bvh, const WideBvh& wide, const Vec3& p, double limit,
               std::size_t& looked_at) {
  double best = limit * limit;
  float cutoff = wide.frame().cutoff(best);
  wide.visit_near(
      p, cutoff, [] { return false; },
      [&](std::uint32_t place) {
        ++looked_at;
        const Triangle& t = mesh.triangles[bvh.order()[place]];
        const Vec3 q =
            closest_point(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
        const double d = (p - q).squaredNorm();
        if (!(d < best)) return;
        best = d;
        cutoff = wide.frame().cutoff(d);
      });
  return best;
}

TEST(WideBvh, FindsWhatIsNearest) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> number;
  for (const int count : {1, 2, 4, 5, 17, 300}) {
    for (const double size : {1e-6, 1.0, 1e9}) {
      const Mesh mesh = soup(random, count, size);
      for (const Bvh& bvh : {Bvh(mesh), Bvh::of_parts(mesh)}) {
        const WideBvh wide(mesh, bvh);
        std::size_t looked_at = 0;
        for (int trial = 0; trial < 50; ++trial) {
          const Vec3 p = size * Vec3(number(random), number(random), number(random));
          double expected = std::numeric_limits<double>::infinity();
          for (const Triangle& t : mesh.triangles)
            expected =
                std::min(expected, (p - closest_point(p, mesh.vertices[t[0]], mesh.vertices[t[1]],
                                                      mesh.vertices[t[2]]))
                                       .squaredNorm());
          EXPECT_EQ(nearest(mesh, bvh, wide, p, 1e100, looked_at), expected) << count << trial;
          // What is just beyond a limit is not found, what is just within is.
          const double d = std::sqrt(expected);
          EXPECT_EQ(nearest(mesh, bvh, wide, p, 1.001 * d, looked_at), expected);
          EXPECT_EQ(nearest(mesh, bvh, wide, p, 0.999 * d, looked_at), 0.999 * d * (0.999 * d));
        }
        if (count == 300) {
          EXPECT_LT(looked_at, 150U * 40);  // of 45,000
        }
      }
    }
  }
}

// A vicinity that holds a point with what is near it gives what all of the hierarchy does; one that
// does not says so.
TEST(WideBvh, VicinitiesHoldWhatIsNear) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> number;
  for (const int count : {1, 4, 5, 17, 300}) {
    for (const double size : {1e-6, 1.0, 1e9}) {
      const Mesh mesh = soup(random, count, size);
      const Bvh bvh(mesh);
      const WideBvh wide(mesh, bvh);
      WideBvh::Vicinity vicinity;
      std::size_t held = 0, looked_at = 0;
      for (int trial = 0; trial < 50; ++trial) {
        const Vec3 center = size * Vec3(number(random), number(random), number(random));
        const double radius = size * std::abs(number(random));
        wide.gather(center, radius, vicinity);
        for (int k = 0; k < 8; ++k) {
          const Vec3 p =
              center + 0.7 * radius * Vec3(number(random), number(random), number(random));
          std::size_t ignored = 0;
          const double expected = nearest(mesh, bvh, wide, p, 1e100, ignored);
          EXPECT_EQ(vicinity.holds(p, expected),
                    (p - center).norm() + std::sqrt(expected) <= radius);
          if (!vicinity.holds(p, expected)) continue;
          ++held;
          double best = std::numeric_limits<double>::infinity();
          float cutoff = wide.frame().cutoff(expected);
          const auto visit = [&](std::uint32_t place) {
            ++looked_at;
            const Triangle& t = mesh.triangles[bvh.order()[place]];
            best = std::min(best, (p - closest_point(p, mesh.vertices[t[0]], mesh.vertices[t[1]],
                                                     mesh.vertices[t[2]]))
                                      .squaredNorm());
          };
          wide.visit_near(
              vicinity, p, cutoff, [] { return false; }, visit);
          EXPECT_EQ(best, expected) << count << trial;
        }
      }
      if (count != 300) continue;
      EXPECT_GT(held, 30U);
      EXPECT_LT(looked_at, 30 * held);
    }
  }
}

TEST(WideBvh, OfNoTrianglesVisitsNone) {
  const WideBvh none;
  const float far = 1;
  EXPECT_EQ(none.visit_near(
                Vec3::Zero(), far, [] { return false; }, [](std::uint32_t) { FAIL(); }),
            0U);
  WideBvh::Vicinity vicinity;
  none.gather(Vec3::Zero(), 1, vicinity);
  none.visit_near(
      vicinity, Vec3::Zero(), far, [] { return false; }, [](std::uint32_t) { FAIL(); });
}

}  // namespace
}  // namespace kaboum::geom
