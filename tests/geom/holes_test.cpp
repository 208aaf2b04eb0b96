#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/holes.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/topology.h>

#include <algorithm>

#include "support/families.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::geom {
namespace {

TEST(FillHoles, MakesAClosedChainAndKeepsTheTriangles) {
  int open = 0;
  for (const auto& f : kaboum::test::open_families()) {
    const Mesh mesh = weld(f.mesh);
    const Mesh closed = fill_holes(mesh).mesh;
    EXPECT_TRUE(kaboum::test::closed_chain(closed)) << f.name;
    ASSERT_GE(closed.triangles.size(), mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      EXPECT_EQ(closed.triangles[i], mesh.triangles[i]);
    open += closed.triangles.size() > mesh.triangles.size() ? 1 : 0;
  }
  EXPECT_GE(open, 2);
}

TEST(FillHoles, LeavesClosedMeshesAlone) {
  for (const auto& f : kaboum::test::closed_families()) {
    if (f.mesh.triangles.size() > 3000) continue;
    const Mesh mesh = weld(f.mesh);
    EXPECT_EQ(fill_holes(mesh).mesh.triangles.size(), mesh.triangles.size()) << f.name;
  }
}

TEST(CloseHoles, GivesASolidThatKeepsTheTriangles) {
  int open = 0;
  for (const auto& f : kaboum::test::open_families()) {
    SolidMesh solid;
    try {
      solid = prepare(f.mesh).solid;
    } catch (const Error&) {
      continue;  // one-sided
    }
    const SolidMesh closed = close_holes(solid);
    EXPECT_TRUE(closed.closed()) << f.name;
    EXPECT_TRUE(kaboum::test::closed_chain(closed.mesh())) << f.name;
    EXPECT_EQ(closed.border(), std::vector<char>(closed.mesh().vertices.size(), 0));
    EXPECT_EQ(closed.filled_triangles(),
              closed.mesh().triangles.size() - solid.mesh().triangles.size());
    for (std::size_t t = 0; t < solid.mesh().triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(closed.mesh().vertices[closed.mesh().triangles[t][k]],
                  solid.mesh().vertices[solid.mesh().triangles[t][k]]);
    open += solid.closed() ? 0 : 1;
    EXPECT_EQ(close_holes(closed).mesh().triangles, closed.mesh().triangles);
  }
  EXPECT_GE(open, 2);
}

// The middle of a square hole lies on a corner of another part: it is welded to that.
TEST(CloseHoles, WeldsAMiddleThatLiesOnAVertex) {
  Mesh cube = kaboum::test::box({2, 2, 2}, 1);
  std::erase_if(cube.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](std::uint32_t v) { return cube.vertices[v].z() == 2; });
  });
  const Mesh tip = kaboum::test::translated(kaboum::test::box({1, 1, 1}, 1), {1, 1, 2});
  const SolidMesh solid = prepare(kaboum::test::merged({cube, tip})).solid;
  ASSERT_FALSE(solid.closed());
  const SolidMesh closed = close_holes(solid);
  EXPECT_TRUE(kaboum::test::closed_chain(closed.mesh()));
  EXPECT_EQ(closed.filled_triangles(), 4U);
  EXPECT_EQ(closed.mesh().vertices.size(), solid.mesh().vertices.size());
  EXPECT_EQ(weld(closed.mesh()).vertices.size(), closed.mesh().vertices.size());
}

}  // namespace
}  // namespace kaboum::geom
