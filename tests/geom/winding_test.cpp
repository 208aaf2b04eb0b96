#include <kaboum/geom/winding.h>

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "support/families.h"
#include "support/fan.h"
#include "support/oracle.h"

namespace {

using kaboum::geom::Mesh;
using kaboum::geom::Vec3;
using kaboum::geom::WindingNumber;

// Against signed tetrahedra in rational arithmetic, at random points and at the nastiest ones: on
// vertical lines through vertices, edges and faces.
TEST(WindingNumber, AgreesWithTheOracleOnEveryFamily) {
  std::mt19937_64 random(3);
  for (const auto& family : kaboum::test::closed_families()) {
    const Mesh& mesh = family.mesh;
    const WindingNumber winding(mesh);
    const auto box = kaboum::geom::bounding_box(mesh);
    std::uniform_real_distribution<double> unit(-0.1, 1.1);
    std::uniform_int_distribution<std::size_t> any(0, mesh.triangles.size() - 1);
    const int samples = mesh.triangles.size() > 3000 ? 6 : 24;
    for (int i = 0; i < samples; ++i) {
      Vec3 p =
          box.min + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(box.max - box.min);
      const auto& t = mesh.triangles[any(random)];
      if (i % 3 == 1) p.head<2>() = mesh.vertices[t[0]].head<2>();
      if (i % 3 == 2) p.head<2>() = (0.5 * (mesh.vertices[t[0]] + mesh.vertices[t[1]])).head<2>();
      const auto w = winding(p);
      if (!w) continue;  // on the surface
      ASSERT_EQ(*w, kaboum::test::winding_number_slow(mesh, p)) << family.name << " sample " << i;
    }
  }
}

// Needles round two tips, in a hierarchy that holds parts of them: each counts once.
TEST(WindingNumber, CountsTrianglesInSeveralLeavesOnce) {
  const Mesh mesh = kaboum::test::double_fan(1000);
  const auto parts = std::make_shared<const kaboum::geom::Bvh>(kaboum::geom::Bvh::of_parts(mesh));
  EXPECT_GT(parts->order().size(), mesh.triangles.size());
  const WindingNumber winding(mesh), of_parts(mesh, parts);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::uniform_int_distribution<std::size_t> any(0, mesh.triangles.size() - 1);
  const auto box = kaboum::geom::bounding_box(mesh);
  for (int i = 0; i < 2000; ++i) {
    Vec3 p =
        box.min + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(box.max - box.min);
    const auto& t = mesh.triangles[any(random)];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (i % 4 == 1) p.head<2>() = a.head<2>();
    if (i % 4 == 2) p.head<2>() = (0.5 * (a + b)).head<2>();
    if (i % 4 == 3) p = a + 0.3 * unit(random) * (b - a) + 0.7 * unit(random) * (c - a);
    if (i % 40 == 3) p = a;
    ASSERT_EQ(winding(p), of_parts(p)) << i;
    int sum = 0, all = 0;
    winding.crossings(p, [&](std::uint32_t, int crossing) { sum += 3 + crossing; });
    of_parts.crossings(p, [&](std::uint32_t, int crossing) { all += 3 + crossing; });
    ASSERT_EQ(sum, all) << i;
  }
}

TEST(WindingNumber, KnowsPointsOnTheSurface) {
  const Mesh cube{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{0, 2, 1},
       {0, 3, 2},
       {4, 5, 6},
       {4, 6, 7},
       {0, 1, 5},
       {0, 5, 4},
       {1, 2, 6},
       {1, 6, 5},
       {2, 3, 7},
       {2, 7, 6},
       {3, 0, 4},
       {3, 4, 7}}};
  const WindingNumber winding(cube);
  EXPECT_EQ(winding(Vec3(0.5, 0.5, 0.5)), 1);
  EXPECT_EQ(winding(Vec3(0.5, 0.5, 1.5)), 0);
  EXPECT_EQ(winding(Vec3(0.5, 0.5, -0.5)), 0);
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(1, 0.25, 0.75), Vec3(0.5, 0.5, 1)})
    EXPECT_FALSE(winding(p)) << p.transpose();
  // Beside, above and below faces, in their planes.
  for (const Vec3& p : {Vec3(1.5, 0.5, 0), Vec3(1, 0.5, -1), Vec3(1, 1, 2), Vec3(0, 0, -3)})
    EXPECT_EQ(winding(p), 0) << p.transpose();
}

}  // namespace
