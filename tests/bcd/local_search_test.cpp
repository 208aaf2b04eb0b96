/// Parts of the search alone: bodies as nodes of the tree of cuts, moves between them, bodies whose
/// pieces go to their neighbours, and hulls that are simplified within a distance.

#include "local_search.h"

#include <gtest/gtest.h>

#include "body_removal.h"
#include "solids.h"

namespace kaboum::bcd {
namespace {

/// Every leaf of the tree is in one of the bodies, and in no two of them.
void expect_partition(const CutTree& tree, const std::vector<Body>& bodies) {
  std::vector<int> leaves;
  for (const Body& b : bodies)
    for (const int leaf : leaves_of(tree, b)) leaves.push_back(leaf);
  std::sort(leaves.begin(), leaves.end());
  EXPECT_EQ(leaves, tree.leaves());
}

class LocalSearchTest : public ::testing::Test {
 protected:
  LocalSearchTest() {
    state_.begin_cutting();
    while (state_.tree().leaf_count() < 24 && state_.tree().cut_worst()) {
    }
  }

  const Mesh mesh_ = kaboum::test::torus(1, 0.35, 24, 12);
  const CoverOptions options_ = test::quick(mesh_, 5);
  SearchState state_{mesh_, options_, 1e12, tuning(Effort::Fast)};
  LocalSearch local_{state_};
};

TEST_F(LocalSearchTest, NodesAreAsManyAsAskedForAndTheSameLeaves) {
  const CutTree& tree = state_.tree();
  const Body all = union_of(tree, state_.solid(), tree.leaves());
  EXPECT_EQ(nodes_of(tree, all, 1), std::vector<int>{0});
  for (const std::size_t least : {2U, 7U, 24U, 1000U}) {
    const std::vector<int> nodes = nodes_of(tree, all, least);
    EXPECT_GE(nodes.size(), std::min(least, tree.leaf_count()));
    EXPECT_EQ(leaves_of(tree, union_of(tree, state_.solid(), nodes)).size(), tree.leaf_count());
  }
  const double distance = 0.5 * tree.nodes()[0].concavity.worst;
  for (const int node : nodes_of(tree, all, 1, distance))
    EXPECT_TRUE(tree.is_leaf(node) || tree.nodes()[node].concavity.worst <= distance);
}

TEST_F(LocalSearchTest, AUnionIsAsFarAsItsEstimate) {
  const std::vector<Body> bodies = state_.leaf_bodies();
  std::vector<double> distances;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const UnionEstimate e = estimate_union(bodies[0], bodies[i], state_.solid(), kUnbounded);
    EXPECT_TRUE(e.whole);
    const Body both = union_of(bodies[0], bodies[i], state_.solid());
    // Facets in one plane are triangulated otherwise, so samples, 1.5 spacings apart, are
    // elsewhere.
    EXPECT_NEAR(e.worst, both.concavity.worst, 0.25 * state_.solid().spacing());
    distances.push_back(e.worst);
  }
  std::sort(distances.begin(), distances.end());
  const double limit = distances[distances.size() / 2];
  std::size_t whole = 0;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const UnionEstimate e = estimate_union(bodies[0], bodies[i], state_.solid(), limit);
    EXPECT_EQ(e.whole, e.worst <= limit);
    whole += e.whole ? 1 : 0;
  }
  EXPECT_GT(whole, 0U);
  EXPECT_LT(whole, distances.size());
}

TEST_F(LocalSearchTest, RefiningLowersTheLargestDistanceOfUnevenBodies) {
  // One body takes half of all leaves, which is far from the solid.
  std::vector<Body> bodies = state_.leaf_bodies();
  std::vector<int> half;
  while (bodies.size() > 12) {
    half.push_back(bodies.back().leaves[0]);
    bodies.pop_back();
  }
  std::sort(half.begin(), half.end());
  bodies.push_back(union_of(state_.tree(), state_.solid(), half));
  const double before = worst_of(bodies);
  const std::size_t count = bodies.size();
  local_.refine(bodies, count);
  EXPECT_LT(worst_of(bodies), 0.8 * before);
  EXPECT_LE(bodies.size(), count);
  expect_partition(state_.tree(), bodies);
}

TEST_F(LocalSearchTest, PartsOfABodyAreItsLeaves) {
  const Body all = union_of(state_.tree(), state_.solid(), state_.tree().leaves());
  const std::vector<Body> parts = local_.split_body(all, 1e-3 * state_.solid().diagonal());
  EXPECT_GE(parts.size(), 2U);
  expect_partition(state_.tree(), parts);
  const Body leaf = body_of(state_.tree(), state_.tree().leaves()[0]);
  EXPECT_NE(local_.split_body(leaf, 0).size(), 1U);
}

TEST_F(LocalSearchTest, RemovedBodiesLeaveOthersWithinEpsilonThatHoldTheirLeaves) {
  const double epsilon = 0.2 * state_.solid().diagonal();
  Finisher finisher(state_);
  std::vector<Body> bodies = state_.leaf_bodies();
  std::vector<Finished> finished = finisher.finish(bodies, 0, epsilon);
  const std::size_t before = finished.size();
  ASSERT_TRUE(are_within(finished, epsilon));
  remove_bodies(state_, finisher, finished, epsilon);
  EXPECT_LT(finished.size(), before);
  EXPECT_TRUE(are_within(finished, epsilon));
  bodies.clear();
  for (const Finished& f : finished) bodies.push_back(f.body);
  expect_partition(state_.tree(), bodies);

  const std::size_t vertices = vertices_of(finished);
  finisher.simplify_hulls(finished, epsilon);
  EXPECT_LT(vertices_of(finished), vertices);
  EXPECT_TRUE(are_within(finished, epsilon));
}

}  // namespace
}  // namespace kaboum::bcd
