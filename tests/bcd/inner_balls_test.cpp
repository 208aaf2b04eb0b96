// Balls that are searched for inside solids: what they promise, by the judge and by rational
// numbers, and mutants of them.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/inner.h>
#include <kaboum/geom/float32.h>
#include <kaboum/verify/cover.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "solids.h"
#include "support/ball_oracle.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using geom::ConvexSet;
using geom::Mesh;
using geom::Vec3;
using test::prism;
using verify::Answer;

InnerBallOptions options_of(const Mesh& mesh, double epsilon_percent) {
  InnerBallOptions out;
  out.epsilon = 0.01 * epsilon_percent * geom::bounding_box(mesh).diagonal();
  out.effort = Effort::Fast;
  return out;
}

InnerCandidate fill(const Mesh& mesh, double epsilon_percent) {
  return find_inner_balls(geom::prepare(mesh).solid, options_of(mesh, epsilon_percent));
}

const Vec3& center_of(const geom::ConvexBody& body) { return body.core.vertices[0]; }

bool is_in_a_ball(const ConvexSet& set, const Vec3& p) {
  for (const geom::ConvexBody& body : set.bodies)
    if (kaboum::test::is_in_ball(center_of(body), body.radius, p)) return true;
  return false;
}

void expect_claims(const Mesh& mesh, const InnerCandidate& found) {
  const ConvexSet set = test::set_of(found.bodies);
  for (const geom::ConvexBody& body : set.bodies) {
    EXPECT_TRUE(geom::is_float32(center_of(body)));
    EXPECT_TRUE(geom::is_float32(body.radius));
    EXPECT_GT(body.radius, 0);
  }
  EXPECT_LE(found.uncovered_depth_lower, found.uncovered_depth_upper);
  if (!set.bodies.empty()) {
    const verify::Claim within = verify::verify_within(set, mesh).solid;
    EXPECT_EQ(within.answer, Answer::Verified) << within.reason;
  }
  const verify::Claim depth = verify::verify_depth(mesh, set, found.uncovered_depth_upper);
  EXPECT_EQ(depth.answer, Answer::Verified) << depth.reason;
}

Mesh l_shape() { return prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1); }

/// A box with a void that has a box in it.
Mesh nested() {
  using kaboum::test::box;
  using kaboum::test::translated;
  return kaboum::test::merged(
      {box({4, 4, 4}, 1), kaboum::test::flipped(translated(box({2, 2, 2}, 1), Vec3::Constant(1))),
       translated(box({1, 1, 1}, 1), Vec3::Constant(1.5))});
}

TEST(InnerBallSearch, LieInEveryFamily) {
  int seen = 0, filled = 0, done = 0;
  test::for_each_solid(400, [&](const kaboum::test::Family& f, const geom::Prepared& prepared) {
    // Every triangle crosses others; minutes.
    if (f.name == "component-twice-rotated") return;
    const Mesh& mesh = prepared.solid.mesh();
    const InnerCandidate found = find_inner_balls(prepared.solid, options_of(mesh, 4));
    if (found.stop == Stop::TooCoarse) return;
    ++seen;
    filled += found.bodies.empty() ? 0 : 1;
    done += found.stop == Stop::Done ? 1 : 0;
    expect_claims(mesh, found);
  });
  EXPECT_GE(seen, 10);
  EXPECT_GE(filled, 8);
  EXPECT_GE(done, seen - 2);  // surfaces that cross themselves everywhere
}

// By rational numbers alone.
TEST(InnerBallSearch, HoldWhatIsDeepByRationalNumbers) {
  struct Case {
    const char* name;
    Mesh mesh;
    double percent;
  };
  for (const Case& one :
       {Case{"cube", kaboum::test::box({1, 1, 1}, 1), 5}, Case{"L", l_shape(), 4},
        Case{"torus", kaboum::test::torus(1, 0.4, 12, 7), 4}, Case{"nested", nested(), 3},
        Case{"noisy", kaboum::test::noisy(kaboum::test::icosphere(1), 0.2, 3), 5}}) {
    SCOPED_TRACE(one.name);
    const Mesh mesh = geom::prepare(one.mesh).solid.mesh();
    const InnerCandidate found = fill(mesh, one.percent);
    expect_claims(mesh, found);
    const ConvexSet set = test::set_of(found.bodies);
    for (const geom::ConvexBody& body : set.bodies)
      EXPECT_TRUE(kaboum::test::is_ball_in_solid(mesh, center_of(body), body.radius));
    const geom::Box3 box = geom::bounding_box(mesh);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    int deep = 0;
    for (int i = 0; i < 1500; ++i) {
      const Vec3 p =
          box.min +
          (box.max - box.min).cwiseProduct(Vec3(unit(random), unit(random), unit(random)));
      if (kaboum::test::winding_number_slow(mesh, p).value_or(0) < 1) continue;
      if (kaboum::test::compare_distance(mesh, p, found.uncovered_depth_upper) <= 0) continue;
      ++deep;
      EXPECT_TRUE(is_in_a_ball(set, p)) << p.transpose();
    }
    EXPECT_GT(deep, 30);
  }
}

// Radii that grow by float32 ulps are refused from the first one on that does not fit by rational
// numbers; without a ball the depth claim is refuted by a point that is deep and in none, or the
// others suffice.
TEST(InnerBallSearch, MutantsAreRefuted) {
  int refuted = 0, needed = 0, balls = 0;
  for (const Mesh& shape : {l_shape(), kaboum::test::torus(1, 0.4, 12, 7), nested()}) {
    const Mesh mesh = geom::prepare(shape).solid.mesh();
    const InnerCandidate found = fill(mesh, 5);
    const double epsilon = found.uncovered_depth_upper;
    for (std::size_t i = 0; i < found.bodies.size(); ++i) {
      ++balls;
      ConvexSet mutant = test::set_of(found.bodies);
      geom::ConvexBody& body = mutant.bodies[i];
      bool fits = true;
      for (int ulps = 1; fits && ulps <= 64; ++ulps) {
        body.radius += geom::float32_spacing(body.radius);
        fits = kaboum::test::is_ball_in_solid(mesh, center_of(body), body.radius);
        const Answer answer = verify::verify_within(mutant, mesh).solid.answer;
        EXPECT_EQ(answer, fits ? Answer::Verified : Answer::Refuted);
      }
      refuted += fits ? 0 : 1;

      mutant = test::set_of(found.bodies);
      mutant.bodies.erase(mutant.bodies.begin() + static_cast<std::ptrdiff_t>(i));
      const verify::Claim depth = verify::verify_depth(mesh, mutant, epsilon);
      ASSERT_NE(depth.answer, Answer::Undecided) << depth.reason;
      if (depth.answer != Answer::Refuted) continue;
      ++needed;
      EXPECT_FALSE(is_in_a_ball(mutant, depth.witness->point));
      EXPECT_EQ(kaboum::test::winding_number_slow(mesh, depth.witness->point), 1);
      EXPECT_GT(kaboum::test::compare_distance(mesh, depth.witness->point, epsilon), 0);
    }
  }
  EXPECT_GE(balls, 60);
  EXPECT_GE(refuted, balls - 2);
  EXPECT_GE(2 * needed, balls);
}

TEST(InnerBallSearch, NumbersThatAreKnown) {
  // The ball in a ball, and what little depth is left between.
  const Mesh ball = kaboum::test::icosphere(3);
  EXPECT_EQ(fill(ball, 10).bodies.size(), 1U);
  // Deep nowhere.
  const Mesh plate = kaboum::test::box({4, 4, 0.1}, 1);
  EXPECT_TRUE(fill(plate, 2).bodies.empty());
  expect_claims(plate, fill(plate, 2));
  // Walls inside cost nothing.
  const Mesh two =
      kaboum::test::merged({kaboum::test::box({2, 1, 1}, 1),
                            kaboum::test::translated(kaboum::test::box({2, 1, 1}, 1), {1, 0, 0})});
  const std::size_t one = fill(kaboum::test::box({3, 1, 1}, 1), 4).bodies.size(),
                    other = fill(two, 4).bodies.size();
  EXPECT_GT(one, 5U);
  EXPECT_LE(other, 2 * one);
}

TEST(InnerBallSearch, ANumberIsKept) {
  const Mesh torus = kaboum::test::torus(1, 0.3, 24, 12);
  const geom::Prepared prepared = geom::prepare(torus);
  InnerBallOptions options;
  options.effort = Effort::Fast;
  double last = 1e9;
  for (const std::size_t n : {1U, 12U, 40U}) {
    options.max_bodies = n;
    const InnerCandidate found = find_inner_balls(prepared.solid, options);
    EXPECT_EQ(found.stop, Stop::Done);
    EXPECT_LE(found.bodies.size(), n);
    EXPECT_LE(found.uncovered_depth_upper, last);
    expect_claims(prepared.solid.mesh(), found);
    last = found.uncovered_depth_upper;
  }
  EXPECT_LT(last, 0.3);  // the tube's radius
  options.epsilon = 0.5 * last;
  const InnerCandidate few = find_inner_balls(prepared.solid, options);
  EXPECT_EQ(few.stop, Stop::TooManyBodies);
  EXPECT_LE(few.bodies.size(), 40U);
  options.epsilon = 0.29;
  const InnerCandidate enough = find_inner_balls(prepared.solid, options);
  EXPECT_EQ(enough.stop, Stop::Done);
  EXPECT_EQ(enough.uncovered_depth_upper, 0.29);
}

// Boxes that cut each other: what the exact check finds is kept clear of then.
TEST(InnerBallSearch, KeepClearOfWhatTheExactCheckFinds) {
  std::vector<Mesh> boxes;
  for (const double turn : {0.0, 1.1, 2.3})
    boxes.push_back(kaboum::test::rotated(
        kaboum::test::translated(kaboum::test::box({2, 1, 1}, 1), {-1, -0.5, -0.5}), turn));
  const geom::Prepared input = geom::prepare(kaboum::test::merged(boxes));
  const Mesh& mesh = input.solid.mesh();
  InnerBallOptions options = options_of(mesh, 4);
  InnerCandidate found;
  for (int round = 0; round < 5; ++round) {
    found = find_inner_balls(input.solid, options);
    const verify::Claim within = verify::verify_within(test::set_of(found.bodies), mesh).solid;
    if (within.answer == Answer::Verified) break;
    ASSERT_FALSE(within.outer_triangles.empty());
    options.doubtful.insert(options.doubtful.end(), within.outer_triangles.begin(),
                            within.outer_triangles.end());
  }
  expect_claims(mesh, found);
}

TEST(InnerBallSearch, TheSameForAnyNumberOfThreads) {
  const Mesh mesh = l_shape();
  std::vector<InnerCandidate> found;
  for (const std::size_t threads : {1U, 2U, 5U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    found.push_back(fill(mesh, 3));
  }
  for (const InnerCandidate& other : found) {
    ASSERT_EQ(other.bodies.size(), found[0].bodies.size());
    for (std::size_t i = 0; i < other.bodies.size(); ++i) {
      EXPECT_EQ(center_of(other.bodies[i]), center_of(found[0].bodies[i]));
      EXPECT_EQ(other.bodies[i].radius, found[0].bodies[i].radius);
    }
  }
}

ErrorCode refused(const Mesh& mesh, const InnerBallOptions& options) {
  try {
    find_inner_balls(geom::prepare(mesh).solid, options);
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::Internal;
}

TEST(InnerBallSearch, RefusesWhatMeansNothing) {
  const Mesh cube = kaboum::test::box({1, 1, 1}, 1);
  EXPECT_EQ(refused(cube, {}), ErrorCode::InvalidArgument);
  InnerBallOptions options;
  options.epsilon = 0;
  EXPECT_EQ(refused(cube, options), ErrorCode::InvalidArgument);
  options.epsilon.reset();
  options.max_bodies = 0;
  EXPECT_EQ(refused(cube, options), ErrorCode::InvalidArgument);
  options = options_of(cube, 5);
  options.doubtful = {12};
  EXPECT_EQ(refused(cube, options), ErrorCode::InvalidArgument);
  Mesh open = cube;
  open.triangles.pop_back();
  EXPECT_EQ(refused(open, options_of(cube, 5)), ErrorCode::InvalidInput);
  // Millions of balls.
  EXPECT_EQ(refused(cube, options_of(cube, 0.02)), ErrorCode::LimitReached);
  const Mesh far = kaboum::test::translated(cube, {1e9, 0, 0});
  EXPECT_EQ(find_inner_balls(geom::prepare(far).solid, options_of(cube, 1)).stop, Stop::TooCoarse);
}

}  // namespace
}  // namespace kaboum::bcd
