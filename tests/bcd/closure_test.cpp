#include <gtest/gtest.h>
#include <kaboum/bcd/closure.h>
#include <kaboum/geom/topology.h>

#include "support/families.h"
#include "support/oracle.h"

namespace kaboum::bcd {
namespace {

TEST(CloseHoles, MakesAClosedChainAndKeepsTheTriangles) {
  int open = 0;
  for (const auto& f : kaboum::test::open_families()) {
    const geom::Mesh mesh = geom::weld(f.mesh);
    const geom::Mesh closed = close_holes(mesh);
    EXPECT_TRUE(kaboum::test::closed_chain(closed)) << f.name;
    ASSERT_GE(closed.triangles.size(), mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      EXPECT_EQ(closed.triangles[i], mesh.triangles[i]);
    open += closed.triangles.size() > mesh.triangles.size() ? 1 : 0;
  }
  EXPECT_GE(open, 2);
}

TEST(CloseHoles, LeavesClosedMeshesAlone) {
  for (const auto& f : kaboum::test::closed_families()) {
    if (f.mesh.triangles.size() > 3000) continue;
    const geom::Mesh mesh = geom::weld(f.mesh);
    EXPECT_EQ(close_holes(mesh).triangles.size(), mesh.triangles.size()) << f.name;
  }
}

}  // namespace
}  // namespace kaboum::bcd
