#include <gtest/gtest.h>
#include <kaboum/geom/holes.h>
#include <kaboum/geom/topology.h>

#include "support/families.h"
#include "support/oracle.h"

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

}  // namespace
}  // namespace kaboum::geom
