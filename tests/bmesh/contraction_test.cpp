// Contractions by themselves, without regions, measuring or optimising: every one keeps all exact
// tests.
#include "contraction.h"

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/verify/inclusion.h>

#include <optional>

#include "compact.h"
#include "support/families.h"
#include "support/shapes.h"

namespace kaboum::bmesh {
namespace {

struct Bare {
  Bare(const geom::Mesh& mesh, Direction direction) : input(geom::prepare(mesh).solid), steps() {
    options.direction = direction;
    context.emplace(input.mesh(), input.closed(), options);
    contraction.emplace(*context, WorkingMesh(input), context->cost.initial(input.mesh()), nullptr,
                        &steps);
  }
  [[nodiscard]] geom::Mesh result() {
    return compact(contraction->mesh().position, contraction->mesh().mesh);
  }

  DecimateOptions options;
  geom::SolidMesh input;
  std::vector<Step> steps;
  std::optional<Context> context;
  std::optional<Contraction> contraction;
};

/// Admits all, and tries again what was refused.
struct Again : CollapsePolicy {
  [[nodiscard]] CollapseEvaluator::Purpose purpose() const override {
    return CollapseEvaluator::Purpose::Due;
  }
  [[nodiscard]] bool tries_again() const override { return true; }
  [[nodiscard]] bool is_hopeful(const BucketQueue::Entry&) override { return true; }
  void has_no_place(const BucketQueue::Entry&) override {}
  [[nodiscard]] bool goes_on() override { return true; }
  [[nodiscard]] bool assess(BucketQueue::Entry&) override { return true; }
  [[nodiscard]] bool admit(BucketQueue::Entry&) override { return true; }
  void before() override {}
  void after() override {}
};

TEST(Contraction, EnclosesAndCountsItsSteps) {
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    for (const geom::Mesh& mesh : {test::icosphere(2), test::torus(1, 0.4, 24, 12)}) {
      Bare bare(mesh, d);
      const std::size_t target = bare.input.mesh().vertices.size() / 2;
      bare.contraction->pass(target);
      EXPECT_EQ(bare.contraction->vertices(), target);
      const geom::Mesh result = bare.result();
      EXPECT_EQ(result.vertices.size(), target);
      EXPECT_EQ(bare.steps.size(), bare.input.mesh().vertices.size() - target);
      EXPECT_EQ(bare.contraction->statistics().contractions, bare.steps.size());
      const bool outer = d == Direction::Outer;
      EXPECT_EQ(verify::verify_inclusion(outer ? bare.input.mesh() : result,
                                         outer ? result : bare.input.mesh())
                    .solid.answer,
                verify::Answer::Verified);
    }
  }
}

// The cheapest first, and nothing beyond the limit; another pass with more of it goes on.
TEST(Contraction, StopsAtTheLimitOfCosts) {
  Bare bare(test::noisy(test::icosphere(2), 0.02, 1), Direction::Outer);
  const std::size_t all = bare.contraction->vertices();
  bare.contraction->pass(4, 1e-6);
  const std::size_t some = bare.contraction->vertices();
  bare.contraction->pass(4, 1e-3);
  const std::size_t few = bare.contraction->vertices();
  EXPECT_LT(few, some);
  EXPECT_LE(some, all);
  EXPECT_GT(few, 4U);
}

// What is refused is tried again when its star has changed: no pass leaves an edge that another
// pass would contract.
TEST(Contraction, LeavesNothingToAnotherPass) {
  std::uint64_t refused = 0;
  Again again;
  std::vector<test::Family> families = test::closed_families();
  for (test::Family& f : test::open_families()) families.push_back(std::move(f));
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    for (const test::Family& f : families) {
      std::optional<Bare> bare;
      try {
        bare.emplace(f.mesh, d);
      } catch (const Error&) {
        continue;  // sheets
      }
      bare->contraction->pass(0, Contraction::kNoLimit, &again);
      const DecimateStatistics& s = bare->contraction->statistics();
      refused += s.rejected_no_position + s.rejected_fold + s.rejected_topology;
      const std::size_t left = bare->contraction->vertices();
      EXPECT_FALSE(bare->contraction->pass(0)) << f.name;
      EXPECT_EQ(bare->contraction->vertices(), left) << f.name;
    }
  }
  EXPECT_GT(refused, 0U);
}

// Every valid candidate is on or beyond the planes of all triangles that it replaces; exactly.
TEST(CollapseEvaluator, PlacesEncloseTheTrianglesTheyReplace) {
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    Bare bare(test::noisy(test::icosphere(2), 0.03, 2), d);
    const geom::Mesh& mesh = bare.input.mesh();
    std::size_t valid = 0, refused = 0;
    for (const geom::Triangle& t : mesh.triangles) {
      if (t[0] > t[1]) continue;
      if (bare.contraction->evaluate(t[0], t[1], CollapseEvaluator::Purpose::Any) !=
          CollapseEvaluator::Validity::Valid) {
        ++refused;
        continue;
      }
      ++valid;
      CollapseEvaluator& evaluator = bare.contraction->evaluator();
      const Vec3 place = evaluator.candidate().position;
      std::vector<std::uint32_t> removed;
      std::vector<NewTriangle> added;
      evaluator.describe(removed, added);
      EXPECT_EQ(removed.size(), added.size() + 2);
      const geom::Sign inner = d == Direction::Outer ? geom::Sign::Negative : geom::Sign::Positive;
      for (const std::uint32_t r : removed) {
        const geom::Triangle& s = mesh.triangles[r];
        EXPECT_NE(
            geom::orient3d(mesh.vertices[s[0]], mesh.vertices[s[1]], mesh.vertices[s[2]], place),
            inner);
      }
    }
    EXPECT_GT(valid, 100U);
    EXPECT_LT(refused, valid);
  }
}

TEST(CollapseEvaluator, EdgesThatWouldPinchAreRefused) {
  // Two tetrahedra on a common triangle: its edges have a third vertex in common beside theirs.
  const geom::Mesh two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1}, {0.3, 0.3, -1}},
                       {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}}};
  Bare bare(two, Direction::Outer);
  EXPECT_EQ(bare.contraction->evaluate(0, 1, CollapseEvaluator::Purpose::Any),
            CollapseEvaluator::Validity::None);
  EXPECT_GT(bare.contraction->statistics().rejected_topology, 0U);
}

}  // namespace
}  // namespace kaboum::bmesh
