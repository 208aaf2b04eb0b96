#include "deviation.h"

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace {

using kaboum::bmesh::Connectivity;
using kaboum::bmesh::Deviation;

// The original between its vertices is seen, each place once.
TEST(Deviation, RefinesWherePlacesAreFarOnce) {
  const auto sphere = kaboum::test::icosphere(3);
  Connectivity mesh(sphere.vertices.size(), sphere.triangles);
  Deviation deviation(sphere);
  deviation.assign(sphere.vertices, mesh);
  const std::size_t before = deviation.samples();
  deviation.refine(sphere.vertices, mesh, 1e-8);
  EXPECT_EQ(deviation.samples(), before);  // nothing is far from itself
  std::vector<kaboum::geom::Vec3> smaller;
  for (const auto& p : sphere.vertices) smaller.emplace_back(0.9 * p);
  deviation.assign(smaller, mesh);
  deviation.refine(smaller, mesh, 0.05 * 0.05);
  const std::size_t refined = deviation.samples();
  EXPECT_GT(refined, before);
  deviation.refine(smaller, mesh, 0.05 * 0.05);
  EXPECT_EQ(deviation.samples(), refined);
}

}  // namespace
