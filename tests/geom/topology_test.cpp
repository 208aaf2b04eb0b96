#include <kaboum/geom/topology.h>

#include <gtest/gtest.h>

#include "support/families.h"
#include "support/oracle.h"

namespace {

using kaboum::geom::analyse;
using kaboum::geom::Mesh;
using kaboum::geom::weld;

const Mesh kTetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

TEST(Analyse, CountsAClosedManifold) {
  const auto r = analyse(kTetrahedron);
  EXPECT_EQ(r.vertices, 4U);
  EXPECT_EQ(r.edges, 6U);
  EXPECT_EQ(r.components, 1U);
  EXPECT_TRUE(r.closed());
  EXPECT_TRUE(r.manifold());
  EXPECT_NEAR(kaboum::geom::signed_volume(kTetrahedron), 1.0 / 6, 1e-15);
}

TEST(Analyse, FindsOpenInconsistentAndNonManifoldPlaces) {
  Mesh open = kTetrahedron;
  open.triangles.pop_back();
  EXPECT_EQ(analyse(open).open_edges, 3U);
  EXPECT_FALSE(analyse(open).closed());

  Mesh turned = kTetrahedron;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(analyse(turned).inconsistent_edges, 3U);
  EXPECT_EQ(analyse(turned).unbalanced_edges, 3U);

  Mesh twice = kTetrahedron;
  twice.triangles.insert(twice.triangles.end(), kTetrahedron.triangles.begin(),
                         kTetrahedron.triangles.end());
  EXPECT_EQ(analyse(twice).duplicate_triangles, 4U);
  EXPECT_EQ(analyse(twice).nonmanifold_edges, 6U);
  EXPECT_TRUE(analyse(twice).closed());

  // Two tetrahedra that share one vertex.
  Mesh touching = kTetrahedron;
  for (const auto& p : {kaboum::geom::Vec3(-1, 0, 0), {0, -1, 0}, {0, 0, -1}})
    touching.vertices.push_back(p);
  for (const auto& t :
       std::vector<kaboum::geom::Triangle>{{0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {5, 6, 0}})
    touching.triangles.push_back(t);
  EXPECT_EQ(analyse(touching).nonmanifold_vertices, 1U);
  EXPECT_EQ(analyse(touching).components, 1U);
}

TEST(Analyse, FindsDegenerateTrianglesExactly) {
  Mesh mesh{{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {3, 3, 3.0000000000000004}}, {{0, 1, 2}, {0, 1, 3}}};
  EXPECT_EQ(analyse(mesh).degenerate_triangles, 1U);
}

TEST(Weld, MergesEqualCoordinatesAndNegativeZero) {
  const Mesh soup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, 0}, {9, 9, 9}, {0, 1, 0}, {0, 0, 1}},
                  {{0, 1, 2}, {3, 5, 6}}};
  const Mesh welded = weld(soup);
  EXPECT_EQ(welded.vertices.size(), 4U);
  EXPECT_EQ(welded.triangles[1], (kaboum::geom::Triangle{0, 2, 3}));
}

TEST(Families, AreClosedAsTheySay) {
  for (const auto& f : kaboum::test::closed_families()) {
    EXPECT_TRUE(analyse(weld(f.mesh)).closed()) << f.name;
    EXPECT_TRUE(kaboum::test::closed_chain(f.mesh)) << f.name;
  }
  for (const auto& f : kaboum::test::open_families())
    EXPECT_FALSE(analyse(weld(f.mesh)).closed()) << f.name;
}

}  // namespace
