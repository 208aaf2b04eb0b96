// The one-sided Hausdorff distance's bracket against truths known by construction and against an
// independent search in long double.
#include <kaboum/geom/directed_distance.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/families.h"

namespace {

using kaboum::geom::directed_distance;
using kaboum::geom::DistanceOptions;
using kaboum::geom::DistanceQuery;
using kaboum::geom::Mesh;
using kaboum::geom::Vec3;
using Wide = Eigen::Matrix<long double, 3, 1>;
using WideTriangle = std::array<Wide, 3>;

/// Coordinates on a grid so coarse that midpoints of edges are doubles exactly, also after
/// `offset`.
Mesh on_grid(Mesh mesh, const Vec3& offset) {
  const auto box = kaboum::geom::bounding_box(mesh);
  const double step = box.diagonal() * 0x1p-12;
  for (Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) v[k] = std::round((v[k] - box.min[k]) / step) * 0x1p-8 + offset[k];
  return mesh;
}

Mesh subdivided(const Mesh& mesh) {
  Mesh out;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const auto n = static_cast<std::uint32_t>(out.vertices.size());
    const auto middle = [](const Vec3& p, const Vec3& q) {
      const Vec3 m = p + 0.5 * (q - p);
      EXPECT_EQ(m - p, q - m);
      return m;
    };
    const Vec3 ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    out.vertices.insert(out.vertices.end(), {a, b, c, ab, bc, ca});
    for (const std::array<std::uint32_t, 3> t :
         {std::array{0U, 3U, 5U}, {3U, 1U, 4U}, {5U, 4U, 2U}, {3U, 4U, 5U}})
      out.triangles.push_back({n + t[0], n + t[1], n + t[2]});
  }
  return out;
}

// Truth 0: a surface against itself and against the same surface in other triangles. Far from the
// origin centroids and the corners of cuts are visibly off the surface.
TEST(Hausdorff, LowerBoundIsZeroForTheSameSurfaceFarFromTheOrigin) {
  for (const auto& family : kaboum::test::closed_families()) {
    if (family.mesh.triangles.size() > 800) continue;
    for (const double far : {0.0, 1e6, 1e9}) {
      const Vec3 offset(std::floor(far), std::floor(2.1 * far), -std::floor(3.7 * far));
      const Mesh mesh = on_grid(family.mesh, offset);
      const Mesh fine = subdivided(mesh);
      const DistanceQuery query(mesh), fine_query(fine);
      const double reach = 3.7 * far + 4096 * 0x1p-8;
      for (const DistanceOptions& options : {DistanceOptions{1e-3, 1e-9}, {1e-3, 1e-6}})
        for (const auto& d :
             {directed_distance(mesh, query, options), directed_distance(mesh, fine_query, options),
              directed_distance(fine, query, options)}) {
          EXPECT_EQ(d.max_lower, 0) << family.name << " " << far;
          EXPECT_GE(d.max_upper, 0) << family.name << " " << far;
          EXPECT_LE(d.max_upper, 1e-13 * reach + 32 * options.absolute_gap)
              << family.name << " " << far;
        }
    }
  }
}

// A surface and its copy, moved exactly by a small distance along the normal of a flat part: the
// truth is known exactly, and far from the origin it is not much larger than the rounding of
// centroids.
TEST(Hausdorff, BracketsAPlatesShiftFarFromTheOrigin) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int run = 0; run < 300; ++run) {
    const double far = std::exp2(std::floor(10 + 20 * unit(random)));
    const double step = far * 0x1p-52;  // an ulp of the coordinates, or two
    const auto grid = [&](double x) { return std::round(x / (8 * step)) * (8 * step); };
    Mesh a;
    const Vec3 o(far + grid(unit(random)), far + grid(unit(random)), far);
    for (int i = 0; i < 3; ++i)
      a.vertices.emplace_back(o.x() + grid(unit(random)), o.y() + grid(unit(random)), o.z());
    a.triangles = {{0, 1, 2}};
    Mesh b = a;
    const double height = 8 * step * (1 + static_cast<double>(random() % 8));
    for (Vec3& v : b.vertices) v.z() += height;
    const auto d = directed_distance(a, DistanceQuery(b));
    EXPECT_LE(d.max_lower, height) << run;
    EXPECT_GE(d.max_upper, height) << run;
  }
}

// -- an independent search ------------------------------------------------------------------------

/// Projection onto the plane, the edges' lines, the corners.
long double distance(const Wide& x, const WideTriangle& t) {
  long double best = std::min({(x - t[0]).norm(), (x - t[1]).norm(), (x - t[2]).norm()});
  for (int k = 0; k < 3; ++k) {
    const Wide e = t[(k + 1) % 3] - t[k];
    const long double s = (x - t[k]).dot(e) / e.squaredNorm();
    if (s > 0 && s < 1) best = std::min(best, (x - t[k] - s * e).norm());
  }
  const Wide n = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = n.squaredNorm() > 0;
  for (int k = 0; inside && k < 3; ++k)
    inside = (t[(k + 1) % 3] - t[k]).cross(x - t[k]).dot(n) >= 0;
  return inside ? std::min(best, std::abs((x - t[0]).dot(n)) / n.norm()) : best;
}

std::vector<WideTriangle> wide(const Mesh& mesh) {
  std::vector<WideTriangle> out;
  for (const auto& [i, j, k] : mesh.triangles)
    out.push_back({mesh.vertices[i].cast<long double>(), mesh.vertices[j].cast<long double>(),
                   mesh.vertices[k].cast<long double>()});
  return out;
}

/// Bracket of sup over A of d(·, B): triangles are quartered at their edges' middles, every
/// triangle of B is tried for each, and d is Lipschitz and, for one triangle, convex. No hierarchy,
/// no hints, no cuts along prisms.
std::pair<long double, long double> slow_supremum(const Mesh& a, const Mesh& b, long double gap) {
  const std::vector<WideTriangle> to = wide(b);
  std::vector<WideTriangle> open = wide(a);
  long double lower = 0, settled = 0;
  const auto nearest = [&](const Wide& x) {
    long double best = distance(x, to[0]);
    for (const WideTriangle& t : to) best = std::min(best, distance(x, t));
    return best;
  };
  for (const WideTriangle& t : open)
    for (const Wide& corner : t) lower = std::max(lower, nearest(corner));
  while (!open.empty()) {
    std::vector<WideTriangle> next;
    for (const WideTriangle& p : open) {
      const Wide center = (p[0] + p[1] + p[2]) / 3;
      const long double here = nearest(center);
      lower = std::max(lower, here);
      long double upper =
          here + std::max({(p[0] - center).norm(), (p[1] - center).norm(), (p[2] - center).norm()});
      for (const WideTriangle& t : to)
        upper =
            std::min(upper, std::max({distance(p[0], t), distance(p[1], t), distance(p[2], t)}));
      if (upper <= lower + gap) {
        settled = std::max(settled, upper);
        continue;
      }
      const Wide x = (p[0] + p[1]) / 2, y = (p[1] + p[2]) / 2, z = (p[2] + p[0]) / 2;
      next.insert(next.end(), {{p[0], x, z}, {x, p[1], y}, {z, y, p[2]}, {x, y, z}});
    }
    open = std::move(next);
  }
  return {lower * (1 - 1e-15L) - 1e-16L, std::max(lower, settled) * (1 + 1e-15L) + 1e-16L};
}

TEST(Hausdorff, MeetsAnIndependentSearch) {
  std::mt19937_64 random(32);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int run = 0; run < 120; ++run) {
    const auto soup = [&](std::size_t triangles, double size) {
      Mesh mesh;
      for (std::size_t t = 0; t < triangles; ++t) {
        const Vec3 at(unit(random), unit(random), unit(random));
        for (int k = 0; k < 3; ++k)
          mesh.vertices.push_back(at + size * Vec3(unit(random), unit(random), unit(random)));
        const auto n = static_cast<std::uint32_t>(3 * t);
        mesh.triangles.push_back({n, n + 1, n + 2});
      }
      return mesh;
    };
    const Mesh a = soup(1 + random() % 5, run % 3 == 0 ? 0.2 : 1);
    const Mesh b = soup(1 + random() % 9, run % 4 == 0 ? 0.1 : 0.7);
    const auto [lower, upper] = slow_supremum(a, b, 1e-4L);
    const auto d = directed_distance(a, DistanceQuery(b), {1e-5, 1e-9});
    EXPECT_LE(d.max_lower, upper) << run;
    EXPECT_GE(d.max_upper, lower) << run;
    EXPECT_TRUE(d.within_gap) << run;
    EXPECT_LE(d.max_upper, d.max_lower * (1 + 1.1e-5)) << run;
  }
}

// Where rounding alone is wider than the wish, the search ends and says so.
TEST(Hausdorff, SaysSoWhenCoordinatesAreTooLargeForTheGap) {
  // The largest distance is inside the face, where only cuts find it.
  Mesh a{{{0, 0, 0}, {10, 0, 0}, {5, 1, 0}}, {{0, 1, 2}}};
  Mesh b{{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {10, 0, 0}, {10, 1, 0}, {10, 0, 1}},
         {{0, 1, 2}, {3, 4, 5}}};
  for (Mesh* mesh : {&a, &b})
    for (Vec3& v : mesh->vertices) v += Vec3(0x1p40, -0x1p41, 0x1p41);
  const auto d = directed_distance(a, DistanceQuery(b), {1e-9, 0});
  EXPECT_FALSE(d.within_gap);
  EXPECT_LE(d.max_lower, 5);
  EXPECT_GE(d.max_upper, 5);
  EXPECT_LE(d.max_upper - d.max_lower, 1e-12 * 0x1p41);
  EXPECT_TRUE(directed_distance(a, DistanceQuery(b), {0.1, 0}).within_gap);
}

}  // namespace
