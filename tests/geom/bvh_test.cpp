// The hierarchy of boxes, against every triangle by itself.
#include <kaboum/geom/bvh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "support/families.h"
#include "support/shapes.h"

namespace kaboum::geom {
namespace {

bool within(const Box3& inner, const Box3& outer) {
  return (outer.min.array() <= inner.min.array()).all() &&
         (inner.max.array() <= outer.max.array()).all();
}

Box3 box_of(const Mesh& mesh, std::uint32_t t) {
  Box3 box;
  for (const std::uint32_t v : mesh.triangles[t]) box.extend(mesh.vertices[v]);
  return box;
}

bool overlap(const Box3& a, const Box3& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

void expect_tree(const Mesh& mesh, const Bvh& bvh, bool parts) {
  const auto nodes = bvh.nodes();
  std::vector<int> seen(mesh.triangles.size(), 0);
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].leaf()) {
      EXPECT_TRUE(within(nodes[i + 1].box, nodes[i].box));
      EXPECT_TRUE(within(nodes[nodes[i].first].box, nodes[i].box));
      continue;
    }
    for (std::uint32_t k = 0; k < nodes[i].count; ++k) {
      const std::uint32_t t = bvh.order()[nodes[i].first + k];
      ++seen[t];
      EXPECT_TRUE(parts || within(box_of(mesh, t), nodes[i].box));
    }
  }
  for (const int n : seen) EXPECT_TRUE(parts ? n >= 1 : n == 1);
}

TEST(Bvh, HoldsEveryTriangleOfTheFamilies) {
  for (const auto& f : kaboum::test::closed_families()) {
    SCOPED_TRACE(f.name);
    expect_tree(f.mesh, Bvh(f.mesh), false);
    expect_tree(f.mesh, Bvh::of_parts(f.mesh), true);
  }
}

TEST(Bvh, FindsWhatMeetsABox) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.4, 1.4);
  for (const Mesh& mesh : {kaboum::test::icosphere(3), kaboum::test::cone(200, 1)}) {
    const Bvh bvh(mesh), parts = Bvh::of_parts(mesh);
    std::size_t met = 0;
    for (int round = 0; round < 200; ++round) {
      Box3 box;
      for (int k = 0; k < 2; ++k) box.extend({unit(random), unit(random), unit(random)});
      std::set<std::uint32_t> expected, found;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (overlap(box_of(mesh, t), box)) expected.insert(t);
      met += expected.size();
      bvh.traverse([&](const Box3& b) { return overlap(b, box); },
                   [&](std::uint32_t t) {
                     if (overlap(box_of(mesh, t), box)) found.insert(t);
                   });
      EXPECT_EQ(found, expected);
      // Parts' boxes are smaller: what has a corner in the box is found all the same.
      found.clear();
      parts.traverse([&](const Box3& b) { return overlap(b, box); },
                     [&](std::uint32_t t) { found.insert(t); });
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t])
          EXPECT_TRUE(!overlap({mesh.vertices[v], mesh.vertices[v]}, box) || found.count(t) == 1);
    }
    EXPECT_GT(met, 1000U);
  }
}

TEST(Bvh, OfNothingIsEmpty) {
  EXPECT_TRUE(Bvh(Mesh{}).empty());
  Bvh().traverse([](const Box3&) { return true; }, [](std::uint32_t) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace kaboum::geom
