#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/inner.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/verify/cover.h>

#include <Eigen/Geometry>
#include <random>
#include <string>

#include "solids.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using geom::Vec3;
using test::prism;

InnerCandidate fill(const Mesh& mesh, double epsilon_percent, std::size_t max_vertices = 64) {
  return find_inner(geom::prepare(mesh).solid,
                    test::quick_inner(mesh, epsilon_percent, max_vertices));
}

verify::Answer inside(const Mesh& mesh, const std::vector<geom::ConvexBody>& bodies) {
  return verify::verify_inclusion(verify::sum_of(test::set_of(bodies)), mesh).solid.answer;
}

void expect_claims(const Mesh& mesh, const InnerCandidate& result, std::size_t max_vertices) {
  test::expect_bodies(result.bodies, max_vertices);
  EXPECT_LE(result.uncovered_depth_lower, result.uncovered_depth_upper);
  if (result.bodies.empty()) return;  // of what is deep nowhere
  EXPECT_EQ(inside(mesh, result.bodies), verify::Answer::Verified);
}

/// Random points of the solid that are deeper than the bound, by the slow oracle: all in a body.
void expect_no_deep_point_left(const Mesh& mesh, const InnerCandidate& result, int count) {
  const geom::Box3 box = geom::bounding_box(mesh);
  const geom::DistanceQuery surface(mesh);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int deep = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3 p =
        box.min + (box.max - box.min).cwiseProduct(Vec3(unit(random), unit(random), unit(random)));
    if (surface.nearest(p).lower <= result.uncovered_depth_upper) continue;
    const auto w = kaboum::test::winding_number_slow(mesh, p);
    if (!w || *w < 1) continue;
    ++deep;
    EXPECT_TRUE(test::covered(result.bodies, p)) << p.transpose();
  }
  EXPECT_GT(deep, 5);
}

TEST(Inner, LiesInEveryFamily) {
  int seen = 0, done = 0;
  test::for_each_solid(400, [&](const kaboum::test::Family& f, const geom::Prepared& prepared) {
    // A body beside its copy, rotated: every triangle crosses others; minutes.
    if (f.name == "component-twice-rotated") return;
    const std::size_t most = seen % 2 == 0 ? 64 : 32;
    const InnerCandidate result = fill(prepared.solid.mesh(), 3, most);
    if (result.stop == Stop::TooCoarse) return;
    expect_claims(prepared.solid.mesh(), result, most);
    done += result.stop == Stop::Done ? 1 : 0;
    ++seen;
  });
  EXPECT_GE(seen, 10);
  EXPECT_GE(done, seen - 2);  // surfaces that cross themselves everywhere
}

TEST(Inner, NoDeepPointIsLeft) {
  for (const double percent : {3.0}) {
    const Mesh knot = geom::prepare(kaboum::test::torus_knot(2, 3, 0.3, 40, 8)).solid.mesh();
    const InnerCandidate result = fill(knot, percent);
    EXPECT_LE(result.uncovered_depth_upper, 0.01 * percent * geom::bounding_box(knot).diagonal());
    expect_claims(knot, result, 64);
    expect_no_deep_point_left(knot, result, 1000);
  }
}

TEST(Inner, WallsBetweenOverlappingBodiesAreNoObstacle) {
  // Two boxes that share a part: the surfaces inside the union count for nothing.
  using kaboum::test::box;
  const Mesh two = kaboum::test::merged(
      {box(Vec3(4, 1, 1), 1), kaboum::test::translated(box(Vec3(4, 1, 1), 1), Vec3(3, 0, 0))});
  const Mesh mesh = geom::prepare(two).solid.mesh();
  const InnerCandidate result = fill(mesh, 1);
  EXPECT_EQ(result.stop, Stop::Done);
  EXPECT_EQ(result.bodies.size(), 1U);
  expect_claims(mesh, result, 64);
}

// Boxes that cut each other: samples beside their triangles miss tips of the outside, which the
// exact check finds. They are kept clear of then.
TEST(Inner, KeepsClearOfWhatTheExactCheckFinds) {
  struct Turned {
    Vec3 half;
    double about_z, about_x;
  };
  std::vector<Mesh> boxes;
  for (const Turned& b :
       {Turned{{1.65, 1.7, 1.12}, 0.78, 0.0}, Turned{{1.43, 1.1, 1.59}, 1.12, 2.31},
        Turned{{0.76, 1.66, 1.54}, 1.24, 1.61}}) {
    Mesh box = kaboum::test::box(2 * b.half, 1);
    for (Vec3& v : box.vertices)
      v = Eigen::AngleAxisd(b.about_x, Vec3::UnitX()) *
          (Eigen::AngleAxisd(b.about_z, Vec3::UnitZ()) * Vec3(v - b.half));
    boxes.push_back(std::move(box));
  }
  const geom::Prepared input = geom::prepare(kaboum::test::merged(boxes));
  InnerOptions options = test::quick_inner(input.solid.mesh(), 1.5, 64);
  const auto check = [&](const InnerCandidate& result) {
    return verify::verify_inclusion(verify::sum_of(test::set_of(result.bodies)), input.solid.mesh())
        .solid;
  };
  const verify::Claim refuted = check(find_inner(input.solid, options));
  ASSERT_EQ(refuted.answer, verify::Answer::Refuted);
  options.doubtful = refuted.outer_triangles;
  options.max_work = 3;
  const InnerCandidate again = find_inner(input.solid, options);
  EXPECT_GT(again.bodies.size(), 3U);
  EXPECT_EQ(check(again).answer, verify::Answer::Verified);
}

TEST(Inner, ObviousOnes) {
  const Mesh l = prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1);
  const InnerCandidate result = fill(l, 0.5);
  EXPECT_EQ(result.bodies.size(), 2U);
  expect_claims(geom::prepare(l).solid.mesh(), result, 64);
  const Mesh one = kaboum::test::box(Vec3(1, 2, 3), 1);
  EXPECT_EQ(fill(one, 0.1).bodies.size(), 1U);
}

TEST(Inner, MutantsAreRefuted) {
  const Mesh l =
      geom::prepare(prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1)).solid.mesh();
  const InnerCandidate result = fill(l, 0.5);
  for (std::size_t i = 0; i < result.bodies.size(); ++i) {
    std::vector<geom::ConvexBody> mutant = result.bodies;  // grown by a hundred thousandth
    const Vec3 center = geom::bounding_box(mutant[i].core).center();
    for (Vec3& p : mutant[i].core.vertices) p = center + (1 + 1e-5) * (p - center);
    EXPECT_EQ(inside(l, mutant), verify::Answer::Refuted);
  }
}

TEST(Inner, EightVerticesPerBodyGetOnInsideRoundWalls) {
  // A body that holds little more than its seed leaves the next search the same place.
  const Mesh torus = geom::prepare(kaboum::test::torus(1, 0.3, 40, 16)).solid.mesh();
  const InnerCandidate result = fill(torus, 2, 8);
  expect_claims(torus, result, 8);
  EXPECT_EQ(result.stop, Stop::Done);
  EXPECT_LE(result.bodies.size(), 400U);
}

TEST(Inner, FewBodiesAndOpenMeshes) {
  const Mesh torus = kaboum::test::torus(1, 0.3, 40, 16);
  InnerOptions options;
  options.effort = Effort::Fast;
  double last = 1e9;
  for (const std::size_t n : {1U, 4U, 12U}) {
    options.max_bodies = n;
    const InnerCandidate result = find_inner(geom::prepare(torus).solid, options);
    EXPECT_LE(result.bodies.size(), n);
    EXPECT_LE(result.uncovered_depth_upper, last);
    EXPECT_LE(result.uncovered_depth_upper, 1.02 * result.uncovered_depth_lower + 1e-6);
    last = result.uncovered_depth_upper;
  }
  Mesh open = kaboum::test::box(Vec3(1, 1, 1), 1);
  open.triangles.pop_back();
  EXPECT_THROW(find_inner(geom::prepare(open).solid, options), Error);
}

TEST(Inner, RefusesDoubtfulTrianglesThatTheMeshHasNot) {
  const Mesh cube = kaboum::test::box({1, 1, 1}, 1);
  InnerOptions options = test::quick_inner(cube, 5);
  options.doubtful = {0, 11};
  EXPECT_FALSE(find_inner(geom::prepare(cube).solid, options).bodies.empty());
  options.doubtful.push_back(12);
  try {
    find_inner(geom::prepare(cube).solid, options);
    ADD_FAILURE() << "triangle 12 of 12 was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find("doubtful triangle 12"), std::string::npos);
  }
}

}  // namespace
}  // namespace kaboum::bcd
