// bound-verify's own judgement of swept sets, attacked with sets whose truth is known.
#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/verify/sweep.h>
#include <tbb/global_control.h>

#include <numbers>

#include "sampling.h"
#include "support/shapes.h"
#include "swept_body.h"
#include "swept_cell.h"

namespace kaboum::test {
namespace {

using verify::Answer;
using verify::KinematicStage;
using verify::MovingShape;

verify::KinematicChain chain_to(const Robot& robot, std::uint32_t link) {
  verify::KinematicChain chain;
  for (std::uint32_t l = link; l > 0; l = robot.joints[l - 1].parent) {
    const Joint& joint = robot.joints[l - 1];
    KinematicStage stage;
    stage.rotation = joint.origin.linear;
    stage.translation = joint.origin.translation;
    if (joint.type == JointType::Revolute) stage.motion = KinematicStage::Motion::Turn;
    if (joint.type == JointType::Prismatic) stage.motion = KinematicStage::Motion::Slide;
    stage.axis = joint.axis;
    stage.variable = joint.variable;
    stage.multiplier = joint.multiplier;
    stage.offset = joint.offset;
    chain.insert(chain.begin(), stage);
  }
  return chain;
}

std::vector<MovingShape> shapes_of(const TestRobot& r) {
  std::vector<MovingShape> out;
  for (const LinkBody& body : r.bodies) {
    MovingShape shape;
    shape.name = body.name;
    shape.mesh = *geom::convex_hull(body.points);
    shape.chain = chain_to(r.robot, body.link);
    out.push_back(std::move(shape));
  }
  return out;
}

verify::SweepClaims judge(const std::vector<MovingShape>& shapes, const Path& path,
                          const geom::ConvexSet& set, double gap = 1e-7) {
  verify::SweepOptions options;
  options.gap = gap;
  return verify::verify_sweep(shapes, path, set, options);
}

SweepResult sweep(const TestRobot& r, const Path& path, double epsilon,
                  StepRule rule = StepRule::Balanced, bool explicit_margin = false,
                  double simplify = 0) {
  SweepOptions options;
  options.simplify = simplify;
  options.epsilon = epsilon;
  options.rule = rule;
  options.explicit_margin = explicit_margin;
  return swept_volume(r.robot, r.bodies, path, options);
}

geom::ConvexSet set_of(const std::vector<geom::Mesh>& bodies, double margin) {
  geom::ConvexSet set;
  for (const geom::Mesh& body : bodies) set.bodies.push_back({"body", body});
  set_margin(set, margin);
  return set;
}

TEST(VerifySweep, AcceptsWhatSweepApproxMakes) {
  std::mt19937_64 random(71);
  for (const TestRobot& r : {six_axis_arm(), prismatic_chain()}) {
    for (int motion = 0; motion < 5; ++motion) {
      const Path path = random_path(r.robot, random, 2 + motion % 2, 1.5, motion % 2 == 0);
      const StepRule rule = motion % 2 == 0 ? StepRule::Balanced : StepRule::Adaptive;
      const SweepResult made = sweep(r, path, 0.005, rule, motion == 3, motion == 4 ? 0.3 : 0);
      const auto claims = judge(shapes_of(r), path, made.set);
      EXPECT_EQ(claims.surface.answer, Answer::Verified) << r.name << claims.surface.reason;
      EXPECT_EQ(claims.solid.answer, Answer::Verified) << r.name << claims.solid.reason;
      EXPECT_LE(claims.farthest.distance, margin_of(made.set).value());
    }
  }
}

// One body holds a whole shape during most of the motion: few cells are looked at, curved shapes
// included.
TEST(VerifySweep, HoldsShapesAsWholes) {
  std::mt19937_64 random(75);
  TestRobot r = prismatic_chain();
  Joint& follows = r.robot.joints.back();
  follows.variable = r.robot.joints.front().variable;
  follows.multiplier = -0.7;
  follows.offset = 0.2;
  std::vector<MovingShape> shapes;
  r.bodies.clear();
  for (std::uint32_t link = 1; link <= r.robot.joints.size(); ++link) {
    MovingShape shape;
    shape.name = "shape";
    shape.kind = link % 3 == 0   ? MovingShape::Kind::Box
                 : link % 3 == 1 ? MovingShape::Kind::Cylinder
                                 : MovingShape::Kind::Sphere;
    shape.size = {0.06, 0.1, 0.08};
    shape.chain = chain_to(r.robot, link);
    shapes.push_back(shape);
    std::vector<Vec3> around;  // a box that holds it
    for (const double x : {-0.061, 0.061})
      for (const double y : {-0.061, 0.061})
        for (const double z : {-0.061, 0.061}) around.emplace_back(x, y, z);
    r.bodies.push_back({"around", link, around, 0});
  }
  const Path path = random_path(r.robot, random, 2, 1.5, false);
  const SweepResult made = sweep(r, path, 0.005, StepRule::Balanced, true);
  const auto claims = judge(shapes, path, made.set);
  EXPECT_EQ(claims.surface.answer, Answer::Verified) << claims.surface.reason;
  EXPECT_EQ(claims.solid.answer, Answer::Verified) << claims.solid.reason;
  EXPECT_LT(claims.cells, 20 * made.set.bodies.size());
  // Without some body, or with all of them a little smaller, it must not.
  for (std::size_t i = 0; i < made.set.bodies.size(); i += 3) {
    geom::ConvexSet some = made.set;
    some.bodies.erase(some.bodies.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(judge(shapes, path, some, 1e-4).surface.answer, Answer::Verified) << i;
  }
}

TEST(VerifySweep, AcceptsExplicitMarginsWhereNothingMoves) {
  // Two halves of a box on the base, cut askew: enlarged by what rounding moves them by alone, they
  // would overlap by too little for the triangles that the cut crosses to be divided so finely.
  TestRobot r = six_axis_arm();
  std::vector<Vec3> box, lower, upper;
  for (const double x : {0.0, 0.3})
    for (const double y : {0.0, 0.2}) {
      const Vec3 cut(x, y, 0.1 + 0.37 * x + 0.21 * y);
      box.insert(box.end(), {{x, y, 0}, {x, y, 0.4}});
      lower.insert(lower.end(), {{x, y, 0}, cut});
      upper.insert(upper.end(), {{x, y, 0.4}, cut});
    }
  r.bodies = {{"box", 0, box, 0}};
  const auto shapes = shapes_of(r);
  r.bodies = {{"lower", 0, lower, 0}, {"upper", 0, upper, 0}};
  std::mt19937_64 random(79);
  const Path path = random_path(r.robot, random, 2, 1.5, false);
  const SweepResult made = sweep(r, path, 0.005, StepRule::Balanced, true);
  const auto claims = judge(shapes, path, made.set, 1e-9);
  EXPECT_EQ(claims.surface.answer, Answer::Verified) << claims.surface.reason;
  EXPECT_EQ(claims.solid.answer, Answer::Verified) << claims.solid.reason;
}

TEST(VerifySweep, RefutesACutMargin) {
  std::mt19937_64 random(72);
  for (const TestRobot& r : {six_axis_arm(), prismatic_chain()}) {
    const Path path = random_path(r.robot, random, 2, 1.5, false);
    SweepResult made = sweep(r, path, 0.005);
    const auto shapes = shapes_of(r);
    const double largest = judge(shapes, path, made.set).farthest.distance;
    EXPECT_GT(largest, 0.8 * margin_of(made.set).value()) << "an idle check";
    for (const double factor : {1 - 1e-9, 0.99, 0.5}) {
      set_margin(made.set, factor * largest);
      const auto claims = judge(shapes, path, made.set);
      EXPECT_EQ(claims.surface.answer, Answer::Refuted) << r.name << ' ' << factor;
      ASSERT_TRUE(claims.refuting);
      // The witness is right, by kinematics of another kind and another distance.
      const verify::SweepPlace& place = *claims.refuting;
      const std::uint32_t link = r.bodies[place.shape].link;
      const Transform pose = reference_pose(r.robot, link, between(path[0], path[1], place.s));
      const geom::Mesh& mesh = shapes[place.shape].mesh;
      EXPECT_LT(distance_to(mesh, pose.linear.transpose() * (place.point - pose.translation)),
                1e-12);
      double nearest = 1e9;
      for (const auto& body : made.set.bodies)
        nearest = std::min(nearest, distance_to(body.core, place.point));
      EXPECT_GT(nearest, margin_of(made.set).value());
      EXPECT_NEAR(nearest, place.distance, 1e-12);
    }
  }
}

TEST(VerifySweep, RefutesAMissingBodyAndAnotherPath) {
  std::mt19937_64 random(73);
  const TestRobot r = six_axis_arm();
  const Path path = random_path(r.robot, random, 2, 1.5, false);
  const SweepResult made = sweep(r, path, 0.005);
  const auto shapes = shapes_of(r);
  std::size_t refuted = 0;
  for (std::size_t missing = 0; missing < made.set.bodies.size(); ++missing) {
    geom::ConvexSet set = made.set;
    set.bodies.erase(set.bodies.begin() + static_cast<std::ptrdiff_t>(missing));
    const auto claims = judge(shapes, path, set);
    EXPECT_NE(claims.surface.answer, Answer::Undecided);
    if (claims.surface.answer == Answer::Refuted) ++refuted;
  }
  EXPECT_EQ(refuted, made.set.bodies.size());  // each is needed
  for (std::size_t joint = 0; joint < 6; ++joint) {
    Path other = path;
    other[1][joint] += 0.05;
    EXPECT_EQ(judge(shapes, other, made.set).surface.answer, Answer::Refuted) << joint;
  }
  EXPECT_EQ(judge(shapes, path, {}).surface.answer, Answer::Refuted);
}

TEST(VerifySweep, ComingBackToTheStartIsNotStayingThere) {
  TestRobot r = six_axis_arm();
  const Path full{std::vector<double>(6, 0.3), {0.3 + 2 * M_PI, 0.3, 0.3, 0.3, 0.3, 0.3}};
  const SweepResult rest = sweep(r, {full[0]}, 0.005);
  EXPECT_EQ(judge(shapes_of(r), {full[0]}, rest.set).surface.answer, Answer::Verified);
  EXPECT_EQ(judge(shapes_of(r), full, rest.set).surface.answer, Answer::Refuted);
}

TEST(VerifySweep, AHollowSetDoesNotHoldTheInside) {
  // Slabs round a cube cover its surface all along a slide, and leave a hole in the middle.
  std::vector<geom::Mesh> slabs;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {-1.2, 0.7}) {
      Vec3 low = Vec3::Constant(-1.2), size = Vec3::Constant(2.4);
      low[axis] = at;
      size[axis] = 0.5;
      slabs.push_back(translated(box(size, 1), low));
    }
  }
  MovingShape cube;
  cube.name = "cube";
  cube.mesh = translated(box({2, 2, 2}, 1), {-1, -1, -1});
  KinematicStage slide;
  slide.motion = KinematicStage::Motion::Slide;
  cube.chain = {slide};
  const Path path{{-0.1}, {0.1}};
  const auto hollow = judge({cube}, path, set_of(slabs, 0.01));
  EXPECT_EQ(hollow.surface.answer, Answer::Verified) << hollow.surface.reason;
  EXPECT_EQ(hollow.solid.answer, Answer::Refuted);
  ASSERT_TRUE(hollow.solid.witness);
  EXPECT_LT(hollow.solid.witness->point.cwiseAbs().maxCoeff(), 0.7);
  slabs.push_back(translated(box({1.5, 1.5, 1.5}, 1), {-0.75, -0.75, -0.75}));
  EXPECT_EQ(judge({cube}, path, set_of(slabs, 0.01)).solid.answer, Answer::Verified);
  cube.mesh.triangles.pop_back();
  const auto open = judge({cube}, path, set_of(slabs, 0.01));
  EXPECT_EQ(open.open_meshes, 1U);
  EXPECT_EQ(open.solid.answer, Answer::Undefined);
  MovingShape solid = cube;  // primitives are solid by themselves
  solid.kind = MovingShape::Kind::Box;
  solid.mesh = {};
  solid.size = {2, 2, 2};
  EXPECT_EQ(judge({solid}, path, set_of(slabs, 0.01)).surface.answer, Answer::Verified);
  slabs.pop_back();
  EXPECT_EQ(judge({solid}, path, set_of(slabs, 0.01)).surface.answer, Answer::Refuted);
}

TEST(VerifySweep, CurvedShapesAreTakenAsTheyAre) {
  // A regular prism and an icosphere inside what they stand for: the margin decides.
  const int sides = 24;
  const double sagitta = 1 - std::cos(M_PI / sides);
  MovingShape shape;
  shape.name = "round";
  shape.kind = MovingShape::Kind::Cylinder;
  shape.size = {1, 2, 1};
  const geom::Mesh prism = translated(cylinder(sides, 2, 1, 0), {0, 0, -1});
  const Path rest{{}};
  EXPECT_EQ(judge({shape}, rest, set_of({prism}, sagitta * 1.001)).surface.answer,
            Answer::Verified);
  EXPECT_EQ(judge({shape}, rest, set_of({prism}, sagitta * 0.999)).surface.answer, Answer::Refuted);
  shape.kind = MovingShape::Kind::Sphere;
  const geom::Mesh ball = convex_hull(icosphere(2).vertices);
  double inner = 1;
  for (const geom::Triangle& t : ball.triangles) {
    const Vec3& a = ball.vertices[t[0]];
    inner = std::min(inner,
                     a.dot((ball.vertices[t[1]] - a).cross(ball.vertices[t[2]] - a).normalized()));
  }
  EXPECT_EQ(judge({shape}, rest, set_of({ball}, (1 - inner) * 1.001)).surface.answer,
            Answer::Verified);
  EXPECT_EQ(judge({shape}, rest, set_of({ball}, (1 - inner) * 0.99)).surface.answer,
            Answer::Refuted);
}

TEST(VerifySweep, HalvesMakeUpCurvedShapes) {
  std::mt19937_64 random(74);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  for (const auto kind : {MovingShape::Kind::Sphere, MovingShape::Kind::Cylinder}) {
    MovingShape shape;
    shape.kind = kind;
    shape.size = {0.7, 1.3, 0.7};
    auto cells = verify::SweptCell::cells_of(shape);
    for (int k = 0; k < 60; ++k) {
      const std::size_t i = random() % cells.size();
      const bool along = cells[i].curved() && k < 40;
      const auto halves = cells[i].halves(along);
      cells[i] = halves.first;
      cells.push_back(halves.second);
    }
    std::vector<geom::Mesh> hulls;
    for (const auto& cell : cells)
      hulls.push_back(*geom::convex_hull({cell.points().begin(), cell.points().end()}));
    for (int k = 0; k < 2000; ++k) {
      Vec3 p(normal(random), normal(random), normal(random));
      if (kind == MovingShape::Kind::Sphere) {
        p = 0.7 * std::cbrt(unit(random)) * p.normalized();
      } else {
        p.head<2>() = (0.7 * std::sqrt(unit(random)) * p.head<2>().normalized()).eval();
        p.z() = 1.3 * (unit(random) - 0.5);
      }
      bool found = false;
      for (std::size_t i = 0; i < cells.size() && !found; ++i)
        found = distance_to(hulls[i], p) <= cells[i].bulge();
      EXPECT_TRUE(found);
    }
  }
}

TEST(VerifySweep, BoundsOfMotionHold) {
  std::mt19937_64 random(75);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const TestRobot& r : test_robots()) {
    const Path path = random_path(r.robot, random, 2, 2, false);
    for (const LinkBody& body : r.bodies) {
      const verify::KinematicChain chain = chain_to(r.robot, body.link);
      double radius = 0;
      for (const Vec3& p : body.points) radius = std::max(radius, p.norm());
      const auto bound = verify::bound_motion(chain, path[0], path[1], radius);
      const double h = 1e-4;
      for (int k = 0; k < 20; ++k) {
        const double s = h + unit(random) * (1 - 2 * h);
        const Vec3& p = body.points[random() % body.points.size()];
        const auto at = [&](double t) -> Vec3 {
          const auto pose = verify::pose_of(chain, between(path[0], path[1], t));
          const Vec3 x = pose.leftCols<3>() * p + pose.col(3);
          const Vec3 y = reference_pose(r.robot, body.link, between(path[0], path[1], t)) * p;
          EXPECT_LE((x - y).norm(), bound.rounding);
          return x;
        };
        const Vec3 before = at(s - h), here = at(s), after = at(s + h);
        EXPECT_LE(here.norm(), bound.distance);
        EXPECT_LE((after - before).norm() / (2 * h), bound.speed * (1 + 1e-9) + 1e-9);
        EXPECT_LE((after - 2 * here + before).norm() / (h * h), bound.acceleration + 1e-4);
      }
    }
  }
}

TEST(VerifySweep, DistancesToBodiesAreBounds) {
  std::mt19937_64 random(76);
  std::normal_distribution<double> normal;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    const geom::Mesh hull = random_hull(seed % 2 == 0 ? 8 : 60, Cloud::Ball, seed);
    const verify::SweptBody body(hull);
    for (int k = 0; k < 500; ++k) {
      const Vec3 p = Vec3(normal(random), normal(random), normal(random));
      const double d = distance_to(hull, p);
      EXPECT_NEAR(body.distance_from_above(p), d, 1e-12);
      EXPECT_NEAR(body.distance_from_below(p), d, 1e-12);
      EXPECT_LE(body.distance_from_below(p), body.distance_from_above(p));
      EXPECT_LE(body.distance_to_box(p), d);
      EXPECT_TRUE(body.holds(p, d + 1e-9));
      if (d > 0) {
        EXPECT_FALSE(body.holds(p, d - 1e-9));
      }
      // Deep inside: the whole ball is inside.
      if (body.holds(p, -0.1)) {
        EXPECT_EQ(
            distance_to(
                hull, p + 0.1 * Vec3(normal(random), normal(random), normal(random)).normalized()),
            0);
      }
    }
  }
}

TEST(VerifySweep, PlanesOfSliversAreKnown) {
  // A cylinder with an explicit margin: its caps have corners in a line but for 1e-17, since the
  // cosine of a right angle is not 0. Leaning ones, where slivers have planes of their own.
  std::mt19937_64 random(80);
  std::normal_distribution<double> normal;
  for (int leaning = 0; leaning < 6; ++leaning) {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    if (leaning > 0) {
      for (double& x : turn.coeffs()) x = normal(random);
      turn.normalize();
    }
    std::vector<Vec3> points;
    for (int i = 0; i < 32; ++i) {
      const double angle = 2 * std::numbers::pi * i / 32;
      for (const double z : {-0.05, 0.05})
        points.emplace_back(turn * Vec3(0.2 * std::cos(angle), 0.2 * std::sin(angle), z));
    }
    points = sweep::enlarge(points, 0.0006);
    for (Vec3& p : points) p = geom::to_float32(p);
    const geom::Mesh hull = *geom::convex_hull(points);
    const verify::SweptBody body(hull);
    EXPECT_TRUE(body.holds(Vec3::Zero(), -0.0505)) << leaning;
    EXPECT_FALSE(body.holds(Vec3::Zero(), -0.051)) << leaning;
    // What it holds, exact predicates hold: points about facets, as near as rounding puts them.
    for (const geom::Triangle& t : hull.triangles) {
      const Vec3 &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
      for (int k = 0; k < 20; ++k) {
        const Vec3 p = (a + b + c) / 3 * (1 + std::ldexp(normal(random), -48 - k / 2));
        if (!body.holds(p, 0)) continue;
        for (const geom::Triangle& u : hull.triangles)
          EXPECT_NE(
              geom::orient3d(hull.vertices[u[0]], hull.vertices[u[1]], hull.vertices[u[2]], p),
              geom::Sign::Positive);
      }
    }
  }
}

TEST(VerifySweep, SameOnAnyNumberOfThreads) {
  std::mt19937_64 random(77);
  const TestRobot r = six_axis_arm();
  const Path path = random_path(r.robot, random, 3, 1.5, false);
  SweepResult made = sweep(r, path, 0.005);
  for (const double factor : {1.0, 0.7}) {
    set_margin(made.set, margin_of(made.set).value() * factor);
    const auto with = [&](std::size_t threads) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      return judge(shapes_of(r), path, made.set);
    };
    const auto a = with(1), b = with(4);
    EXPECT_EQ(a.surface.answer, b.surface.answer);
    EXPECT_EQ(a.cells, b.cells);
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.farthest.point, b.farthest.point);
    EXPECT_EQ(a.farthest.distance, b.farthest.distance);
  }
}

TEST(VerifySweep, LimitsAndBadSets) {
  const TestRobot r = six_axis_arm();
  const Path path{std::vector<double>(6, 0), std::vector<double>(6, 1)};
  SweepResult made = sweep(r, path, 0.005);
  verify::SweepOptions options;
  options.gap = 1e-7;
  options.max_cells = 1;
  // A shape in two pieces, each with bodies of its own, is held by its triangles alone.
  TestRobot two = r;
  const LinkBody piece = two.bodies.back();
  two.bodies = {piece, piece};
  for (Vec3& p : two.bodies[1].points) p += Vec3(0.5, 0, 0);
  std::vector<MovingShape> apart = shapes_of(two);
  apart[0].mesh = merged({apart[0].mesh, apart[1].mesh});
  apart.pop_back();
  const SweepResult both = sweep(two, path, 0.005);
  EXPECT_EQ(judge(apart, path, both.set).surface.answer, Answer::Verified);
  const auto limited = verify::verify_sweep(apart, path, both.set, options);
  EXPECT_EQ(limited.surface.answer, Answer::Undecided);
  EXPECT_NE(limited.solid.answer, Answer::Verified);
  options.max_cells = 20000;
  options.gap = 0.1;  // coarser than the margin: nothing moving can be known
  EXPECT_EQ(verify::verify_sweep(shapes_of(r), path, made.set, options).surface.answer,
            Answer::Undecided);
  std::swap(made.set.bodies[0].core.triangles[0][0], made.set.bodies[0].core.triangles[0][1]);
  const auto bent = judge(shapes_of(r), path, made.set);
  EXPECT_EQ(bent.convex.answer, Answer::Refuted);
  EXPECT_NE(bent.surface.answer, Answer::Verified);
}

}  // namespace
}  // namespace kaboum::test
