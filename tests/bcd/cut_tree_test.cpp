/// The tree of cuts: its pieces, coarse and fine, and how planes sort them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "body.h"
#include "cut_chooser.h"
#include "cut_tree.h"
#include "solids.h"

namespace kaboum::bcd {
namespace {

/// Every leaf is below one of the nodes, and below no two of them.
void expect_whole(const CutTree& tree, const std::vector<int>& nodes) {
  std::vector<int> leaves;
  for (const int node : nodes) tree.leaves_below(node, leaves);
  std::sort(leaves.begin(), leaves.end());
  EXPECT_EQ(leaves, tree.leaves());
}

class CutTreeTest : public ::testing::Test {
 protected:
  CutTreeTest() {
    while (tree_.leaf_count() < 40 && tree_.cut_worst()) {
    }
  }
  const Mesh mesh_ = kaboum::test::torus(1, 0.35, 24, 12);
  const SolidField solid_{mesh_, 20000, 0};
  CutTree tree_{solid_, {}};
};

TEST_F(CutTreeTest, NodesWithinADistanceAreTheCoarsest) {
  const auto& nodes = tree_.nodes();
  std::size_t inner = 0;
  for (const double percent : {0., 1., 2., 5., 10., 50.}) {
    const double distance = 0.01 * percent * solid_.diagonal();
    const std::vector<int> found = tree_.nodes_within(distance);
    expect_whole(tree_, found);
    for (const int node : found) {
      inner += tree_.is_leaf(node) ? 0 : 1;
      EXPECT_TRUE(tree_.is_leaf(node) || nodes[node].concavity.worst <= distance);
      for (int above = nodes[node].parent; above >= 0; above = nodes[above].parent)
        EXPECT_GT(nodes[above].concavity.worst, distance);
    }
  }
  EXPECT_GT(inner, 0U);
}

TEST_F(CutTreeTest, ScoresAboveALimitAreOnlyKnownToBe) {
  CutChooser chooser(solid_, {}, tree_.shift());
  chooser.prepare();
  const CutNode node = make_node(whole(solid_), solid_);
  for (const Vec3& n : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(1, 1, 0).normalized()}) {
    for (int i = -3; i <= 3; ++i) {
      const Plane plane{n, 0.3 * i};
      const double score = chooser.score(node, plane);
      if (!std::isfinite(score)) continue;
      for (const double share : {0.0, 0.1, 0.5, 0.99, 1.0, 1.01, 2.0}) {
        const double found = chooser.score(node, plane, share * score);
        if (share < 1)
          EXPECT_GT(found, share * score);
        else
          EXPECT_EQ(found, score);
      }
    }
  }
}

TEST_F(CutTreeTest, HalvesAreNoNearerThanTheFacetsThatAreNotCut) {
  CutChooser chooser(solid_, {}, tree_.shift());
  chooser.prepare();
  const CutNode node = make_node(whole(solid_), solid_);
  geom::HullBuilder builder;
  const std::vector<FacetShare> facets = facet_shares(node.hull, solid_, builder);
  double all = 0;
  for (const FacetShare& facet : facets) all += facet.fourth;
  ASSERT_GT(all, 0);
  EXPECT_EQ(CutChooser::uncut(node, facets, {Vec3::UnitX(), 2}), all);
  std::size_t some = 0;
  for (const Vec3& n : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(1, 1, 0).normalized()}) {
    for (int i = -3; i <= 3; ++i) {
      const Plane plane{n, 0.3 * i};
      const double kept = CutChooser::uncut(node, facets, plane);
      EXPECT_LE(kept, all);
      some += kept > 0 && kept < all ? 1 : 0;
      // The least that a cut in the middle is preferred by.
      EXPECT_GE(chooser.score(node, plane), 0.9 * 0.4 * kept);
    }
  }
  EXPECT_GT(some, 0U);
}

TEST_F(CutTreeTest, SplitSortsNodesAndLeavesAlike) {
  const Plane plane{Vec3(1, 2, 0.5).normalized(), 0.1};
  std::vector<int> lower, upper;
  tree_.split({0}, plane, lower, upper);
  std::vector<int> all = lower;
  all.insert(all.end(), upper.begin(), upper.end());
  expect_whole(tree_, all);
  EXPECT_LT(all.size(), tree_.leaf_count());  // no finer than the plane asks for
  const double least = 8.001 * tree_.shift();
  for (const int node : lower)
    for (const Vec3& p : tree_.nodes()[node].hull) EXPECT_LT(plane.height(p), least);
  for (const int node : upper)
    for (const Vec3& p : tree_.nodes()[node].hull) EXPECT_GT(plane.height(p), -least);

  // The same plane again cuts nothing, whether asked of the whole or of its leaves.
  const std::size_t leaves = tree_.leaf_count();
  for (const std::vector<int>& from : {std::vector<int>{0}, tree_.leaves()}) {
    std::vector<int> below, above;
    tree_.split(from, plane, below, above);
    EXPECT_EQ(tree_.leaf_count(), leaves);
    below.insert(below.end(), above.begin(), above.end());
    expect_whole(tree_, below);
  }
}

TEST_F(CutTreeTest, ThePlaneFoundIsThatOfTheLeaves) {
  const double far = tree_.nodes()[0].concavity.worst;
  const auto coarse = tree_.find_split({0}, Vec3(1, 1, 0), 2 * far);
  const auto fine = tree_.find_split(tree_.leaves(), Vec3(1, 1, 0), 2 * far);
  ASSERT_TRUE(coarse && fine);
  EXPECT_NEAR(coarse->worst, fine->worst, 1e-3 * far);
  EXPECT_LT(coarse->worst, 1.01 * far);
}

/// A mesh of two boxes.
Mesh boxes(const Vec3& a, const Vec3& b, const Vec3& size) {
  Mesh out;
  for (const auto& [low, high] : {std::pair(Vec3(0, 0, 0), size), std::pair(a, b)}) {
    Mesh one = kaboum::test::box(high - low, 1);
    const geom::Box3 box = geom::bounding_box(one);
    const auto offset = static_cast<std::uint32_t>(out.vertices.size());
    for (const Vec3& p : one.vertices) out.vertices.push_back(p - box.min + low);
    for (const Triangle& t : one.triangles)
      out.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return out;
}

TEST(CutTree, UnionsAreNoNearerThanTheirBoundBelow) {
  const Mesh mesh = boxes({0, 0, 1.5}, {1, 1, 2}, {1, 1, 1});
  const SolidField solid(mesh, 20000, 0);
  CutTree tree(solid, {});
  ASSERT_TRUE(tree.cut_worst());
  ASSERT_EQ(tree.leaf_count(), 2U);
  const Body a = body_of(tree, 1), b = body_of(tree, 2);
  const double bound = distance_from_below(a, b, solid, 1);
  const UnionEstimate hull = estimate_hull(a, b, solid, 1);
  EXPECT_TRUE(hull.whole);
  EXPECT_NEAR(hull.worst, 0.25, 0.02);
  EXPECT_GT(bound, 0.1);
  EXPECT_LE(bound, 0.25 + 1e-9);
  // No hull is built where the bound suffices.
  EXPECT_FALSE(estimate_union(a, b, solid, 0.1).whole);
  EXPECT_TRUE(estimate_union(a, b, solid, 0.3).whole);
}

}  // namespace
}  // namespace kaboum::bcd
