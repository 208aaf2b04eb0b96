// Derived families of grasps, against members that are moved here by angle and axis, and boxes that
// are told apart by the fifteen axes of two boxes.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/scene/derived_features.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "blocks.h"

namespace kaboum::scene {
namespace {

constexpr double kPi = std::numbers::pi;

/// Where the tool of a member is, in the object's frame.
Transform tool_of_member(const world::Grasp& grasp, const std::vector<double>& values) {
  Transform tool = tool_in_object(grasp);
  if (grasp.turn) {
    const Eigen::Matrix3d turn(Eigen::AngleAxisd(values.back(), grasp.turn->axis));
    tool = {turn * tool.linear, grasp.turn->point + turn * (tool.translation - grasp.turn->point)};
  }
  for (std::size_t i = 0; i < grasp.slides.size(); ++i)
    tool.translation += values[i] * grasp.slides[i].direction;
  return tool;
}

/// Values of a member: of corners of the bounds, or anywhere.
std::vector<double> values_within(const world::Grasp& grasp, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(-0.25, 1.25);
  std::vector<double> out;
  const auto add = [&](double from, double to) {
    out.push_back(from + std::clamp(share(random), 0.0, 1.0) * (to - from));
  };
  for (const world::FreeSlide& slide : grasp.slides) add(slide.from, slide.to);
  if (grasp.turn) add(grasp.turn->from, grasp.turn->to);
  return out;
}

/// True if two boxes in frames of their own have no point in common (S. Gottschalk 1996).
bool are_apart(const Block& a, const Transform& at_a, const Block& b, const Transform& at_b) {
  std::vector<Vec3> axes;
  for (int i = 0; i < 3; ++i) {
    axes.emplace_back(at_a.linear.col(i));
    axes.emplace_back(at_b.linear.col(i));
    for (int k = 0; k < 3; ++k)
      axes.emplace_back(at_a.linear.col(i).cross(Vec3(at_b.linear.col(k))));
  }
  const Vec3 center_a = at_a * (0.5 * (a.low + a.high)), center_b = at_b * (0.5 * (b.low + b.high));
  const Vec3 half_a = 0.5 * (a.high - a.low), half_b = 0.5 * (b.high - b.low);
  return std::ranges::any_of(axes, [&](const Vec3& axis) {
    const double reach = half_a.dot((at_a.linear.transpose() * axis).cwiseAbs()) +
                         half_b.dot((at_b.linear.transpose() * axis).cwiseAbs());
    return std::abs(axis.dot(center_a - center_b)) > reach;
  });
}

/// A hand of blocks in the tool's frame.
world::World world_of(const std::vector<Block>& hand, const std::vector<Block>& object,
                      const Transform& frame = {}) {
  world::World out = world_with(object, 0, frame);
  out.robots[0].shapes[1].outer = set_of(hand);
  return out;
}

/// Two fingers along y and a palm, as far behind the tips as the fingers are long.
std::vector<Block> fingers(double open, double length) {
  return {{{-0.01, 0.5 * open, -length}, {0.01, 0.5 * open + 0.01, 0.01}},
          {{-0.01, -0.5 * open - 0.01, -length}, {0.01, -0.5 * open, 0.01}},
          {{-0.04, -0.1, -length - 0.03}, {0.04, 0.1, -length}}};
}

/// True if members that are drawn leave the hand apart from the object.
void expect_free(const std::vector<Block>& hand, const std::vector<Block>& object,
                 const Transform& frame, const world::Grasp& grasp, std::mt19937_64& random) {
  for (int n = 0; n < 400; ++n) {
    const std::vector<double> values = values_within(grasp, random);
    const Transform tool = tool_of_member(grasp, values);
    for (const Block& part : hand)
      for (const Block& block : object)
        ASSERT_TRUE(are_apart(part, tool, block, frame))
            << grasp.name << " "
            << Eigen::Map<const Eigen::RowVectorXd>(values.data(),
                                                    static_cast<Eigen::Index>(values.size()));
  }
}

geom::ConvexBody prism(int sides, double radius, double low, double high,
                       const Transform& frame = {}) {
  std::vector<Vec3> points;
  for (int i = 0; i < sides; ++i)
    for (const double z : {low, high})
      points.emplace_back(frame * Vec3(radius * std::cos(2 * kPi * i / sides),
                                       radius * std::sin(2 * kPi * i / sides), z));
  return {"prism", *geom::convex_hull(points)};
}

world::World world_of_bodies(std::vector<geom::ConvexBody> bodies, double epsilon = 0) {
  world::World out = world_with({{{0, 0, 0}, {1, 1, 1}}}, 9);
  out.objects[0].outer = {std::move(bodies), collide::Direction::Outer, epsilon};
  return out;
}

DerivedGrasps derive_families(const world::World& world, GraspRequest request) {
  request.form = GraspRequest::Form::Families;
  return derive_grasps(world, 0, request);
}

TEST(GraspFamilies, OfBoxesAreAnywhereOnTheirFaces) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> size(0.02, 0.2);
  for (int i = 0; i < 20; ++i) {
    const Vec3 half(size(random), size(random), size(random));
    const Transform frame = random_pose(random);
    const world::World world = world_with({{-half, half}}, 9, frame);
    for (const double tip : {0.0, 0.01}) {
      const DerivedGrasps found = derive_families(world, {.opening = 0.2, .tip = tip});
      ASSERT_EQ(found.grasps.size(), (half.array() <= 0.1).count());
      EXPECT_EQ(found.in_contact, 0U);
      for (const world::Grasp& grasp : found.grasps) {
        ASSERT_EQ(grasp.slides.size(), 2U);
        ASSERT_TRUE(grasp.turn);
        EXPECT_NEAR(grasp.turn->to - grasp.turn->from, 2 * kPi, 1e-12);
        const Transform tool = tool_in_object(grasp);
        EXPECT_LT((tool.translation - frame.translation).norm(), 1e-9);
        EXPECT_LT((tool.translation - grasp.turn->point).norm(), 1e-9);
        int normal = 0;
        (frame.linear.transpose() * grasp.turn->axis).cwiseAbs().maxCoeff(&normal);
        for (const world::FreeSlide& slide : grasp.slides) {
          int along = 0;
          const double cosine =
              (frame.linear.transpose() * slide.direction).cwiseAbs().maxCoeff(&along);
          EXPECT_NEAR(cosine, 1, 1e-9);
          EXPECT_NE(along, normal);
          const double reach = tip > 0 ? half[along] - 0.5 * tip : 0.95 * half[along];
          EXPECT_NEAR(slide.to, reach, 1.1e-3 * reach);
          EXPECT_LE(slide.to, reach);
          EXPECT_EQ(slide.from, -slide.to);
        }
      }
    }
  }
}

TEST(GraspFamilies, KeepTheHandFreeAtAllMembers) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> size(0.01, 0.09);
  std::size_t families = 0, partly = 0;
  for (int i = 0; i < 6; ++i) {
    std::vector<Block> object;
    for (int k = 0; k < 1 + i % 3; ++k) {
      const Vec3 at = Vec3(size(random), size(random), size(random)) - Vec3::Constant(0.05);
      const Vec3 half(size(random), size(random), size(random));
      object.push_back({at - half, at + half});
    }
    const Transform frame = random_pose(random);
    const std::vector<Block> hand = fingers(0.08, 0.06);
    const world::World world = world_of(hand, object, frame);
    for (const auto hold : {GraspRequest::Hold::Sides, GraspRequest::Hold::Face}) {
      const DerivedGrasps found = derive_families(world, {.hold = hold, .opening = 0.078});
      for (const world::Grasp& grasp : found.grasps) {
        ++families;
        if (grasp.turn && grasp.turn->to - grasp.turn->from < 6) ++partly;
        expect_free(hand, object, frame, grasp, random);
        if (HasFatalFailure()) return;
      }
    }
  }
  EXPECT_GT(families, 40U);
  EXPECT_GT(partly, 15U);
}

TEST(GraspFamilies, CoverWhatIsFree) {
  // Of all places of the tool on a bar that is longer than fingers are.
  std::mt19937_64 random(13);
  const std::vector<Block> hand = fingers(0.05, 0.05);
  const std::vector<Block> bar{{{-0.02, -0.03, -0.1}, {0.02, 0.03, 0.1}}};
  const world::World world = world_of(hand, bar);
  const DerivedGrasps found = derive_families(world, {.opening = 0.045});
  ASSERT_FALSE(found.grasps.empty());
  const Vec3 closing = tool_in_object(found.grasps[0]).linear.col(1);
  ASSERT_NEAR(std::abs(closing.x()), 1, 1e-9);
  std::uniform_real_distribution<double> share(-1, 1);
  int free = 0, covered = 0;
  for (int n = 0; n < 20000; ++n) {
    const Eigen::Matrix3d turn(Eigen::AngleAxisd(kPi * share(random), Vec3::UnitX()));
    Eigen::Matrix3d tool;
    tool.col(1) = closing;
    tool.col(2) = turn * Vec3::UnitZ();
    tool.col(0) = tool.col(1).cross(tool.col(2));
    const Vec3 at(0, 0.95 * 0.03 * share(random), 0.95 * 0.1 * share(random));
    if (std::ranges::any_of(hand, [&](const Block& part) {
          return !are_apart(part, {tool, at}, bar[0], {});
        }))
      continue;
    ++free;
    covered += std::ranges::any_of(found.grasps, [&](const world::Grasp& grasp) {
      const Transform stated = tool_in_object(grasp);
      const Vec3 to = at - stated.translation;
      for (const world::FreeSlide& slide : grasp.slides)
        if (std::abs(slide.direction.dot(to)) > slide.to) return false;
      const Vec3 z = stated.linear.col(2);
      const double angle = std::acos(std::clamp(z.dot(tool.col(2)), -1.0, 1.0));
      return (stated.linear.col(1) - tool.col(1)).norm() < 1e-6 && angle <= grasp.turn->to;
    });
  }
  EXPECT_GT(free, 2000);
  EXPECT_GT(covered, 0.5 * free) << covered << " of " << free;
}

TEST(GraspFamilies, MissNothingThinBetweenWhatIsLookedAt) {
  // A needle behind the tip, and a needle that sticks out of a cube half way between two cells.
  const std::vector<Block> hand{{{-1e-4, -1e-4, -0.2}, {1e-4, 1e-4, -0.1}}};
  const double half = 0.02;
  for (const double degrees : {5.0, 25.0, 95.1, 174.9}) {
    world::World world = world_of(hand, {{Vec3::Constant(-half), Vec3::Constant(half)}});
    const double a = degrees * kPi / 180;
    const Vec3 out(0, std::cos(a), std::sin(a)), across(0, -std::sin(a), std::cos(a));
    std::vector<Vec3> needle;
    for (const double r : {0.01, 0.3})
      for (const double s : {-1e-4, 1e-4})
        for (const double x : {-1e-4, 1e-4})
          needle.emplace_back(r * out + s * across + Vec3(x, 0, 0));
    const world::World plain = world;
    std::vector<geom::ConvexBody> bodies{{"cube", world.objects[0].outer.body(0).core},
                                         {"needle", *geom::convex_hull(needle)}};
    world.objects[0].outer = {bodies, collide::Direction::Outer, 0};
    int families = 0;
    for (const world::Grasp& grasp : derive_families(world, {}).grasps) {
      const Transform stated = tool_in_object(grasp);
      if (std::abs(grasp.turn->axis.x()) < 0.9 || stated.translation.norm() > 0.03) continue;
      ++families;
      // The tool comes from where the needle is: its z axis is -out.
      const double angle = std::atan2(grasp.turn->axis.dot(stated.linear.col(2).cross(Vec3(-out))),
                                      -stated.linear.col(2).dot(out));
      const auto reach = [&](const Vec3& direction) {
        double sum = 0;
        for (const world::FreeSlide& slide : grasp.slides)
          sum += std::abs(slide.direction.dot(direction)) * slide.to;
        return sum;
      };
      const double aside = std::abs((stated.translation).dot(across)) - reach(across);
      EXPECT_TRUE(std::abs(angle) > grasp.turn->to || aside > 0)
          << degrees << " " << grasp.name << " " << angle;
    }
    EXPECT_GT(families, 0);
    EXPECT_LE(derive_families(plain, {}).grasps.size(), 3U);
  }
}

TEST(GraspFamilies, HoldArcsNotOnlyTheirEnds) {
  // A plate turns below a wall of the hand, which its corners meet in the middle of a cell only.
  const double half = 0.1, wall = half * std::sqrt(2.0) - 2.5e-4;
  ASSERT_GT(wall, half * std::sqrt(2.0) * std::cos(kPi / 36));
  const world::World world = world_of({{{wall, -0.2, -0.02}, {wall + 0.01, 0.2, 0.02}}},
                                      {{{-half, -half, 0}, {half, half, 0.01}}});
  int up = 0;
  for (const world::Grasp& grasp :
       derive_families(world, {.hold = GraspRequest::Hold::Face, .tip = 2 * half - 1e-5}).grasps) {
    if (std::abs(grasp.turn->axis.z()) < 0.9) continue;
    ++up;
    const Transform stated = tool_in_object(grasp);
    for (double angle = grasp.turn->from; angle <= grasp.turn->to; angle += 1e-3) {
      const Eigen::Matrix3d turn(Eigen::AngleAxisd(angle, grasp.turn->axis));
      const Vec3 towards = turn * stated.linear.col(0);
      EXPECT_LT(half * (std::abs(towards.x()) + std::abs(towards.y())), wall);
    }
  }
  EXPECT_GE(up, 4);
}

TEST(GraspFamilies, KeepRoundedBodiesAndMarginsFree) {
  // A capsule along the tool's z axis, beside a ball or a rod, before the hand's own ball.
  geom::ConvexBody capsule{"capsule", {}, 0.02}, ball{"ball", {}, 0.01};
  capsule.core.vertices = {Vec3(0, 0, -0.1), Vec3(0, 0, 0.1)};
  const auto reach = [&](const world::World& world) {
    // How far from above the tool goes along the capsule, to the hand's ball behind it.
    double lowest = 1;
    for (const world::Grasp& grasp : derive_families(world, {.opening = 0.05}).grasps) {
      const Transform tool = tool_in_object(grasp);
      if (tool.linear(2, 2) > -0.99) continue;
      lowest = std::min(lowest, tool.translation.z() + grasp.slides[0].from);
    }
    return lowest;
  };
  world::World world = world_of_bodies({capsule});
  ball.core.vertices = {Vec3(0, 0, -0.1)};
  world.robots[0].tools[0].pose.translation = Vec3::Zero();
  world.robots[0].shapes[1].outer = {{ball}, collide::Direction::Outer, 0};
  // The ball's middle stays 0.03 above the end of the core.
  EXPECT_GE(reach(world), 0.1 + 0.03 - 0.1);
  EXPECT_LE(reach(world), 0.1 + 0.03 - 0.1 + 2e-3);
  world.margins.all = 0.02;
  EXPECT_GE(reach(world), 0.1 + 0.05 - 0.1);
  EXPECT_LE(reach(world), 0.1 + 0.05 - 0.1 + 2e-3);
  world.margins.all = 0;
  world.allowed = {{world::Item{world::Item::kObject, 0}, world::Item{0, 1}}};
  EXPECT_LE(reach(world), -0.09);
  // Looked at from the side, the capsule's thickness counts as well.
  world.allowed.clear();
  ball.core.vertices = {Vec3(0.025, 0, 0)};
  world.robots[0].shapes[1].outer = {{ball}, collide::Direction::Outer, 0};
  EXPECT_TRUE(derive_families(world, {.opening = 0.05}).grasps.empty());
  ball.core.vertices = {Vec3(0.0302, 0, 0)};
  world.robots[0].shapes[1].outer = {{ball}, collide::Direction::Outer, 0};
  EXPECT_FALSE(derive_families(world, {.opening = 0.05}).grasps.empty());
}

TEST(GraspFamilies, AreNotWhereOtherBodiesCoverFaces) {
  // A step on the middle of a plate: tips go beside it only.
  const std::vector<Block> object{{{-0.1, -0.1, -0.01}, {0.1, 0.1, 0.01}},
                                  {{-0.032, -0.1, 0.01}, {0.032, 0.1, 0.03}}};
  const world::World world = world_of({{{-0.3, -0.3, -2}, {0.3, 0.3, -1}}}, object);
  std::mt19937_64 random(14);
  constexpr double kTip = 0.02;
  std::size_t on_plate = 0;
  for (const auto hold : {GraspRequest::Hold::Sides, GraspRequest::Hold::Face})
    for (const world::Grasp& grasp :
         derive_families(world, {.hold = hold, .opening = 0.021, .tip = kTip}).grasps) {
      if (std::abs(grasp.turn->axis.z()) < 0.9) continue;
      const Transform stated = tool_in_object(grasp);
      const bool sides = hold == GraspRequest::Hold::Sides;
      if (!sides && std::abs(stated.translation.z() - 0.011) > 1e-9) continue;
      ++on_plate;
      for (int n = 0; n < 200; ++n) {
        const Vec3 at = tool_of_member(grasp, values_within(grasp, random)).translation;
        EXPECT_GE(std::abs(at.x()), 0.032 + 0.5 * kTip - 1e-9);
        EXPECT_LE(std::abs(at.x()), 0.1 - 0.5 * kTip + 1e-9);
        EXPECT_LE(std::abs(at.y()), 0.1 - 0.5 * kTip + 1e-9);
      }
    }
  EXPECT_GE(on_plate, 4U);
}

/// Families round an axis: the slide goes along it.
std::vector<world::Grasp> round_ones(const DerivedGrasps& found) {
  std::vector<world::Grasp> out;
  for (const world::Grasp& grasp : found.grasps)
    if (grasp.turn && grasp.slides.size() == 1 &&
        grasp.slides[0].direction.cross(grasp.turn->axis).norm() < 1e-9)
      out.push_back(grasp);
  return out;
}

TEST(GraspFamilies, OfPrismsOfManySidesAreRoundTheirAxis) {
  std::mt19937_64 random(15);
  const double tilted = std::sqrt(0.5);
  const std::array from_above{0.0, 1.0, 1.0, tilted, tilted};
  for (const int sides : {4, 6, 8, 12, 16, 24, 64}) {
    const Transform frame = random_pose(random);
    const world::World world = world_of_bodies({prism(sides, 0.03, -0.1, 0.1, frame)});
    const DerivedGrasps found = derive_families(world, {.opening = 0.061});
    const std::vector<world::Grasp> round = round_ones(found);
    if (sides < 16) {
      EXPECT_TRUE(round.empty()) << sides;
      EXPECT_GT(found.grasps.size(), 0U);
      continue;
    }
    ASSERT_EQ(round.size(), 5U) << sides;
    EXPECT_EQ(found.grasps.size(), 5U);  // none of flat parts of what is round
    const Vec3 axis = frame.linear.col(2);
    for (const world::Grasp& grasp : round) {
      EXPECT_LT(grasp.turn->axis.cross(axis).norm(), 1e-9);
      EXPECT_LT((grasp.turn->point - frame.translation).cross(axis).norm(), 1e-9);
      EXPECT_NEAR(grasp.slides[0].to, 0.095, 1e-4);
      const Transform tool = tool_in_object(grasp);
      EXPECT_LT((tool.translation - frame.translation).norm(), 1e-9);
      EXPECT_NEAR(tool.linear.col(1).dot(axis), 0, 1e-9);  // across the axis
      const auto place = static_cast<std::size_t>(&grasp - round.data());
      EXPECT_NEAR(std::abs(tool.linear.col(2).dot(axis)), from_above[place], 1e-9);
    }
    EXPECT_EQ(round[0].rank, 0U);
    EXPECT_EQ(round[3].rank, 1U);
    // Wider than the fingers open.
    EXPECT_TRUE(derive_families(world, {.opening = 0.0585}).grasps.empty());
  }
}

TEST(GraspFamilies, AreRoundWithinEpsilon) {
  // A prism of eight sides is as round as its epsilon says.
  const double out_by = 0.03 * (1 - std::cos(kPi / 8));
  for (const double epsilon : {0.0, 0.7 * out_by, 0.8 * out_by}) {
    const world::World world = world_of_bodies({prism(8, 0.03, -0.1, 0.1)}, epsilon);
    EXPECT_EQ(round_ones(derive_families(world, {.opening = 0.061})).empty(),
              epsilon + 0.02 * 0.03 < out_by)
        << epsilon;
  }
}

TEST(GraspFamilies, OfTurnedPartsAreAtEachOfTheirDiameters) {
  // A bottle: body, shoulder that leans, neck. A bar across the bottom is not round.
  std::vector<Vec3> shoulder;
  for (const auto& [r, z] : {std::pair(0.04, 0.1), std::pair(0.015, 0.12)})
    for (int i = 0; i < 64; ++i)
      shoulder.emplace_back(r * std::cos(2 * kPi * i / 64), r * std::sin(2 * kPi * i / 64), z);
  const world::World world =
      world_of_bodies({prism(64, 0.04, 0, 0.1),
                       {"shoulder", *geom::convex_hull(shoulder)},
                       prism(64, 0.015, 0.12, 0.2),
                       {"bar", hull_of({{-0.05, -0.01, 0}, {0.05, 0.01, 0.02}}, {})}});
  const auto bounds = [](const world::Grasp& grasp) {
    const double z = tool_in_object(grasp).translation.z();
    return std::pair(z + grasp.slides[0].from, z + grasp.slides[0].to);
  };
  const std::vector<world::Grasp> all =
      round_ones(derive_families(world, {.opening = 0.082, .tip = 0.01}));
  ASSERT_EQ(all.size(), 10U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [low, high] = bounds(all[i]);
    // Within a slab of 0.2 / 64.
    EXPECT_GE(low, (i < 5 ? 0.02 : 0.12) + 0.005 - 1e-9) << all[i].name;
    EXPECT_LE(low, (i < 5 ? 0.02 : 0.12) + 0.005 + 0.0033);
    EXPECT_LE(high, (i < 5 ? 0.1 : 0.2) - 0.005 + (i < 5 ? 0.0033 : 0) + 1e-9);
    EXPECT_GE(high, (i < 5 ? 0.1 : 0.2) - 0.005 - 0.0033);
  }
  // Only the neck fits between fingers that open less.
  const std::vector<world::Grasp> neck = round_ones(derive_families(world, {.opening = 0.05}));
  ASSERT_EQ(neck.size(), 5U);
  EXPECT_GE(bounds(neck[0]).first, 0.12);
  // A can with a handle is round about the can's axis, above the handle.
  const world::World mug = world_of_bodies(
      {prism(64, 0.04, 0, 0.1), {"handle", hull_of({{0, -0.01, 0.02}, {0.08, 0.01, 0.04}}, {})}});
  const std::vector<world::Grasp> above = round_ones(derive_families(mug, {.opening = 0.082}));
  ASSERT_GE(above.size(), 5U);
  EXPECT_LT(above[0].turn->point.head<2>().norm(), 1e-9);
  EXPECT_GE(bounds(above[0]).first, 0.04);
  // A cone has no such side.
  std::vector<Vec3> cone{{0, 0, 0.08}};
  for (int i = 0; i < 64; ++i)
    cone.emplace_back(0.04 * std::cos(2 * kPi * i / 64), 0.04 * std::sin(2 * kPi * i / 64), 0);
  EXPECT_TRUE(round_ones(derive_families(world_of_bodies({{"cone", *geom::convex_hull(cone)}}), {}))
                  .empty());
}

TEST(GraspFamilies, OfBallsAndCapsulesAreRoundThem) {
  geom::ConvexBody ball{"ball", {}, 0.03}, capsule{"capsule", {}, 0.03};
  ball.core.vertices = {Vec3(0.1, 0.2, 0.3)};
  const Vec3 axis = Vec3(1, 2, 2) / 3;
  capsule.core.vertices = {-0.1 * axis, 0.1 * axis};
  const std::vector<world::Grasp> of_ball =
      round_ones(derive_families(world_of_bodies({ball}), {.opening = 0.061}));
  ASSERT_GE(of_ball.size(), 15U);
  for (const world::Grasp& grasp : of_ball) {
    // Fingers close across the ball, near its middle.
    EXPECT_LE(grasp.slides[0].to, 0.4 * 0.03);
    EXPECT_LT((grasp.turn->point - ball.core.vertices[0]).cross(grasp.turn->axis).norm(), 1e-5);
  }
  EXPECT_TRUE(derive_families(world_of_bodies({ball}), {.opening = 0.059}).grasps.empty());
  const std::vector<world::Grasp> of_capsule =
      round_ones(derive_families(world_of_bodies({capsule}), {.opening = 0.061}));
  ASSERT_GE(of_capsule.size(), 5U);
  EXPECT_LT(of_capsule[0].turn->axis.cross(axis).norm(), 1e-9);
  EXPECT_GE(of_capsule[0].slides[0].to, 0.09);
  EXPECT_LE(of_capsule[0].slides[0].to, 0.12);
}

TEST(GraspFamilies, OfACanLeaveRoomForThePalm) {
  // From above the palm is over the can, wherever the tool is.
  const std::vector<Block> hand = fingers(0.07, 0.05);
  world::World world = world_of(hand, {{Vec3::Zero(), Vec3::Ones()}});
  world.objects[0].outer = {{prism(64, 0.03, 0, 0.2)}, collide::Direction::Outer, 0};
  const std::vector<world::Grasp> round = round_ones(derive_families(world, {.opening = 0.068}));
  ASSERT_GE(round.size(), 3U);
  bool above = false;
  for (const world::Grasp& grasp : round) {
    const Transform tool = tool_in_object(grasp);
    if (tool.linear(2, 2) > -0.99) continue;
    above = true;
    EXPECT_NEAR(grasp.turn->to, kPi, 1e-12);
    EXPECT_GE(tool.translation.z() + grasp.slides[0].from, 0.15);
    EXPECT_LE(tool.translation.z() + grasp.slides[0].from, 0.155);
  }
  EXPECT_TRUE(above);
}

TEST(GraspFamilies, OfTheLargestFacesComeFirst) {
  const world::World world = world_with({{{0, 0, 0}, {0.02, 0.1, 0.3}}}, 9);
  const DerivedGrasps found = derive_families(world, {});
  ASSERT_EQ(found.grasps.size(), 3U);
  EXPECT_EQ(found.grasps[0].name, "tip/side-1");
  EXPECT_GT(std::abs(found.grasps[0].turn->axis.x()), 0.9);
  EXPECT_EQ(found.grasps[0].rank, 0U);
  EXPECT_GT(std::abs(found.grasps[2].turn->axis.z()), 0.9);
  EXPECT_EQ(found.grasps[2].rank, 1U);
  EXPECT_EQ(derive_families(world, {.most = 2}).grasps.size(), 2U);
}

TEST(GraspFamilies, ComeAfterSinglePosesWhereBothAreAskedFor) {
  const world::World world = world_with({{{0, 0, 0}, {0.02, 0.1, 0.3}}}, 9);
  const DerivedGrasps both = derive_grasps(world, 0, {.most = 3}),
                      poses =
                          derive_grasps(world, 0, {.form = GraspRequest::Form::Poses, .most = 3}),
                      families = derive_families(world, {.most = 3});
  ASSERT_EQ(both.grasps.size(), 6U);
  EXPECT_EQ(both.faces, std::max(poses.faces, families.faces));
  for (std::size_t i = 0; i < 6; ++i) {
    const world::Grasp &grasp = both.grasps[i],
                       &same = i < 3 ? poses.grasps[i] : families.grasps[i - 3];
    EXPECT_EQ(grasp.name, "tip/side-" + std::to_string(i + 1));
    EXPECT_EQ(grasp.pose.translation, same.pose.translation);
    EXPECT_EQ(grasp.slides.size(), same.slides.size());
    EXPECT_EQ(grasp.rank, same.rank + (i < 3 ? 0U : 1U));
  }
  // Where there are no single poses, families are not tried later.
  geom::ConvexBody ball{"ball", {}, 0.03};
  ball.core.vertices = {Vec3(0.1, 0.2, 0.3)};
  EXPECT_EQ(derive_grasps(world_of_bodies({ball}), 0, {}).grasps.at(0).rank, 0U);
}

TEST(GraspFamilies, NeedRoomForTheTips) {
  const world::World world = world_with({{{0, 0, 0}, {0.02, 0.1, 0.3}}}, 9);
  for (const auto hold : {GraspRequest::Hold::Sides, GraspRequest::Hold::Face})
    for (const world::Grasp& grasp : derive_families(world, {.hold = hold, .tip = 0.03}).grasps)
      EXPECT_GT(std::abs(grasp.turn->axis.x()), 0.9);  // other faces are 0.02 wide
  EXPECT_EQ(derive_families(world, {.tip = 0.11}).faces, 0U);
  const world::World disc = world_of_bodies({prism(64, 0.03, 0, 0.02)});
  EXPECT_EQ(round_ones(derive_families(disc, {.opening = 0.061, .tip = 0.019})).size(), 5U);
  EXPECT_EQ(round_ones(derive_families(disc, {.opening = 0.061, .tip = 0.021})).size(), 0U);
  EXPECT_TRUE(derive_families(world, {.tip = 0.11}).grasps.empty());
}

}  // namespace
}  // namespace kaboum::scene
