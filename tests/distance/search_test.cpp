#include <kaboum/distance/search.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/families.h"
#include "support/shapes.h"

namespace {

using kaboum::distance::Backend;
using kaboum::distance::make_search;
using kaboum::geom::Mesh;
using kaboum::geom::TriangleSearch;
using kaboum::geom::Vec3;

/// Bracket of the distance by looking at every triangle.
kaboum::geom::DistanceBounds by_all(const Mesh& mesh, const Vec3& p) {
  kaboum::geom::DistanceBounds best{1e300, 1e300};
  for (const auto& [i, j, k] : mesh.triangles) {
    const auto d = kaboum::geom::point_triangle_distance(p, mesh.vertices[i], mesh.vertices[j],
                                                         mesh.vertices[k]);
    best.lower = std::min(best.lower, d.lower);
    best.upper = std::min(best.upper, d.upper);
  }
  return best;
}

// What float32 culls must not be nearer than what is found: near-ties on the surface itself, close
// to it, and far away, where the float32 grid is coarser than the mesh; at any scale and offset.
TEST(Search, EveryBackendFindsWhatLookingAtAllTrianglesFinds) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const auto& family : kaboum::test::closed_families()) {
    if (family.mesh.triangles.size() > 2000) continue;
    for (const double scale : {1.0, 1e-6, 1e6, 1e-50, 1e50}) {
      for (const double offset : {0.0, 1e5}) {
        Mesh mesh = family.mesh;
        for (Vec3& v : mesh.vertices) v = scale * (v + Vec3::Constant(offset));
        const auto embree = make_search(mesh, Backend::Embree);
        const auto own = make_search(mesh, Backend::Own);
        const auto box = kaboum::geom::bounding_box(mesh);
        const double diagonal = box.diagonal();
        for (int i = 0; i < 6; ++i) {
          const auto& t =
              mesh.triangles[static_cast<std::size_t>(random() % mesh.triangles.size())];
          const double away = i % 3 == 0 ? 1e-9 : i % 3 == 1 ? 0.3 : 3e3;
          const Vec3 p = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3 +
                         away * diagonal * Vec3(unit(random), unit(random), unit(random));
          const auto slow = by_all(mesh, p);
          const double rounding =
              1e-12 * slow.upper + 2e-13 * diagonal + 4e-16 * p.cwiseAbs().maxCoeff();
          for (const auto* search : {embree.get(), own.get()}) {
            const auto n = search->nearest(p);
            EXPECT_GE(n.upper, slow.lower) << family.name;
            EXPECT_LE(n.upper, slow.upper + rounding) << family.name << " " << scale;
            EXPECT_LE(n.lower, slow.upper) << family.name;
            EXPECT_LE(n.upper - n.lower, 1e-8 * n.upper + rounding) << family.name;
            EXPECT_LE(search->to_triangle(p, n.triangle).lower, n.upper);
            const auto hinted =
                search->nearest(p, static_cast<std::uint32_t>(random() % mesh.triangles.size()));
            EXPECT_LE(hinted.upper, slow.upper + rounding) << family.name;
          }
        }
      }
    }
  }
}

// Triangles round a point whose distances differ by far less than float32 can tell apart at these
// coordinates: the nearest one must still be found.
TEST(Search, TellsNearTiesApartBelowFloatResolution) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  for (const double scale : {1.0, 1e-20, 1e20}) {
    Mesh mesh;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const Vec3& v : {a, b, c}) mesh.vertices.emplace_back(scale * v);
      mesh.triangles.push_back({first, first + 1, first + 2});
    };
    add({-1, -1, -1}, {-1, -1, -0.9}, {-1, -0.9, -1});
    add({1, 1, 1}, {1, 1, 0.9}, {1, 0.9, 1});
    std::vector<Vec3> points;
    for (int i = 0; i < 300; ++i) {
      points.emplace_back(0.9 * vector());
      const double radius = std::pow(10, -4 - i % 4);
      for (int t = 0; t < 24; ++t) {
        const Vec3 at = points.back() + radius * (1 + 1e-4 * unit(random)) * vector().normalized();
        add(at, at + 1e-3 * radius * vector(), at + 1e-3 * radius * vector());
      }
    }
    for (const Backend backend : {Backend::Embree, Backend::Own}) {
      const auto search = make_search(mesh, backend);
      for (const Vec3& point : points) {
        const Vec3 p = scale * point;
        EXPECT_LE(search->nearest(p).upper, by_all(mesh, p).upper * (1 + 1e-12));
      }
    }
  }
}

/// Small triangles in the box [−1, 1]³, whose coordinates the Embree search neither shifts nor
/// scales.
struct Specks {
  Mesh mesh;
  Specks() {
    add({-1, -1, -1});
    add({1, 1, 1});
    mesh.vertices[1] += Vec3(0.01, 0, 0);
    mesh.vertices[4] -= Vec3(0.01, 0, 0);
  }
  std::uint32_t add(const Vec3& at) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), 3, at);
    mesh.triangles.push_back({first, first + 1, first + 2});
    return static_cast<std::uint32_t>(mesh.triangles.size() - 1);
  }
};

// The triangle at the origin has a box without extent, at coordinates that float32 holds exactly:
// only the allowance in the radius makes up for the rounding of Embree's squared distances. The
// search starts with another triangle that is farther by less than that.
TEST(Search, AllowsForTheTraversalsRounding) {
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  int found = 0;
  for (int i = 0; i < 1000000 && found < 10; ++i) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    // Representable, so that the query point itself is not moved.
    const Vec3 p = (0.36 * direction).cast<float>().cast<double>();
    // The squared distance rounded up so far that a radius one step above the exact one is less.
    float squared = 0;
    for (int k = 0; k < 3; ++k) squared += static_cast<float>(p[k]) * static_cast<float>(p[k]);
    const float radius = std::nextafter(static_cast<float>(p.norm()), 1.0F);
    if (!(squared > radius * radius)) continue;
    ++found;
    Specks specks;
    specks.add(Vec3::Zero());
    const std::uint32_t hint = specks.add((2 + 4e-12) * p);
    const auto search = make_search(specks.mesh, Backend::Embree);
    EXPECT_LE(search->nearest(p, hint).upper, by_all(specks.mesh, p).upper * (1 + 1e-12)) << i;
  }
  EXPECT_EQ(found, 10);
}

// Close to the query point, at coordinates between float32 numbers: only the outward step of the
// boxes makes up for their rounding.
TEST(Search, AllowsForTheRoundingOfBoxes) {
  std::mt19937_64 random(14);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 400; ++i) {
    const Vec3 p =
        Vec3(0.5 + 0.4 * unit(random), 0.5 + 0.4 * unit(random), 0.6).cast<float>().cast<double>();
    Vec3 by = Vec3::Zero();
    by[i % 3] = (i % 2 == 0 ? 1 : -1) * 1e-3 * (1 + unit(random));
    Specks specks;
    specks.add(p + by);
    const std::uint32_t hint = specks.add(p - (1 + 1e-9) * by);
    const auto search = make_search(specks.mesh, Backend::Embree);
    EXPECT_LE(search->nearest(p, hint).upper, by_all(specks.mesh, p).upper * (1 + 1e-11)) << i;
  }
}

TEST(Search, BothBackendsGiveTheSameLargestDistance) {
  for (const auto& family : kaboum::test::closed_families()) {
    if (family.mesh.triangles.size() > 1500) continue;
    Mesh other = family.mesh;
    const Vec3 center = kaboum::geom::bounding_box(other).center();
    for (Vec3& v : other.vertices) v = center + Vec3(1.05, 0.9, 1.1).cwiseProduct(v - center);
    const auto x =
        kaboum::geom::directed_distance(family.mesh, *make_search(other, Backend::Embree));
    const auto y = kaboum::geom::directed_distance(family.mesh, *make_search(other, Backend::Own));
    EXPECT_LE(x.max_lower, y.max_upper) << family.name;
    EXPECT_LE(y.max_lower, x.max_upper) << family.name;
    EXPECT_TRUE(x.within_gap && y.within_gap) << family.name;
  }
}

TEST(Search, RefusesMeshesWithoutTriangles) {
  for (const Backend backend : {Backend::Embree, Backend::Own})
    EXPECT_ANY_THROW(make_search(Mesh{}, backend));
}

TEST(Search, TakesAPointAsMesh) {
  const Mesh mesh{{{3, 4, 0}}, {{0, 0, 0}}};
  for (const Backend backend : {Backend::Embree, Backend::Own})
    EXPECT_NEAR(make_search(mesh, backend)->nearest({0, 0, 0}).upper, 5, 1e-12);
}

}  // namespace
