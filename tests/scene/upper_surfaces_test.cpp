// Surfaces that look up, against blocks: what is over a block, and under none.

#include <gtest/gtest.h>
#include <kaboum/scene/derived_features.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "blocks.h"

namespace kaboum::scene {
namespace {

using Vec2 = Eigen::Vector2d;

/// A world of an object whose own frame stands upright in the world.
world::World standing(const std::vector<Block>& blocks, const Transform& frame, double epsilon) {
  world::World out = world_with(blocks, 9, frame, epsilon);
  out.objects[0].pose.linear = frame.linear.transpose();
  return out;
}

/// Surfaces in the blocks' frame.
std::vector<std::vector<Vec3>> surfaces_of(const world::World& world, const Transform& frame,
                                           const PlaceRequest& request) {
  std::vector<std::vector<Vec3>> out;
  for (const world::Feature& feature : derive_places(world, 0, request)) {
    if (feature.kind != world::Feature::Kind::Surface) continue;
    EXPECT_EQ(feature.name, out.empty() ? "face" : "face" + std::to_string(out.size() + 1));
    EXPECT_LT((frame.linear.transpose() * feature.direction - Vec3::UnitZ()).norm(), 1e-9);
    std::vector<Vec3>& outline = out.emplace_back();
    for (const Vec3& p : feature.outline)
      outline.emplace_back(frame.linear.transpose() * (p - frame.translation));
  }
  return out;
}

/// How far a point is within an outline, seen from above; below 0: it is outside.
double depth(const std::vector<Vec3>& outline, const Vec2& p) {
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 a = outline[i].head<2>(), edge = outline[(i + 1) % outline.size()].head<2>() - a;
    out = std::min(out, (edge.x() * (p - a).y() - edge.y() * (p - a).x()) / edge.norm());
  }
  return out;
}

/// True if a block ends at a height below a point of the plane, and none goes on there.
bool looks_up(const std::vector<Block>& blocks, const Vec2& p, double height, double least = 1e-7) {
  const auto holds = [&](const Block& b, double more) {
    return (p.array() > b.low.head<2>().array() - more).all() &&
           (p.array() < b.high.head<2>().array() + more).all();
  };
  return std::ranges::any_of(blocks,
                             [&](const Block& b) {
                               return std::abs(b.high.z() - height) < 1e-9 && holds(b, least);
                             }) &&
         std::ranges::none_of(blocks, [&](const Block& b) {
           return b.low.z() < height + 1e-9 && b.high.z() > height + 1e-3 && holds(b, -least);
         });
}

double area_seen(const std::vector<Vec3>& outline) {
  double out = 0;
  for (std::size_t k = 1; k + 1 < outline.size(); ++k)
    out += 0.5 * (outline[k] - outline[0]).cross(outline[k + 1] - outline[0]).z();
  return out;
}

/// Blocks of a few heights on a grid of tenths, some of which touch and some of which overlap.
std::vector<Block> random_blocks(std::mt19937_64& random) {
  std::uniform_int_distribution<int> place(0, 9), size(1, 5), height(0, 2), count(1, 7);
  std::vector<Block> out;
  for (int n = count(random); n > 0; --n) {
    const Vec3 low(0.1 * place(random), 0.1 * place(random), 0.1 * height(random));
    out.push_back(
        {low, low + Vec3(0.1 * size(random), 0.1 * size(random), 0.1 * size(random) / 2)});
  }
  return out;
}

TEST(UpperSurfaces, AreOverBlocksAndUnderNone) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  std::size_t surfaces = 0, smaller = 0;
  for (int i = 0; i < 120; ++i) {
    const std::vector<Block> blocks = random_blocks(random);
    const Transform frame = i % 2 == 0 ? Transform{} : random_pose(random);
    const double epsilon = i % 3 == 0 ? 0 : 0.03, inset = i % 4 == 0 ? 0.02 : 0;
    const world::World world = standing(blocks, frame, epsilon);
    const std::vector<std::vector<Vec3>> found =
        surfaces_of(world, frame, {.most = 100, .inset = Length{inset}});
    double before = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < found.size(); ++s) {
      const std::vector<Vec3>& outline = found[s];
      ++surfaces;
      EXPECT_LE(area_seen(outline), before * (1 + 1e-6));
      before = area_seen(outline);
      const double height = outline.front().z();
      for (std::size_t k = 0; k < outline.size(); ++k) {
        EXPECT_NEAR(outline[k].z(), height, 1e-9);
        // Convex, counterclockwise.
        for (const Vec3& other : outline)
          EXPECT_GT((outline[(k + 1) % outline.size()] - outline[k]).cross(other - outline[k]).z(),
                    -1e-12);
      }
      for (int n = 0; n < 200; ++n) {
        // Any point of it, the corners as well, and any that is no farther away than it is smaller.
        Vec2 p = Vec2::Zero();
        double sum = 0;
        for (const Vec3& corner : outline) {
          const double w = std::pow(share(random), 6);
          p += w * corner.head<2>();
          sum += w;
        }
        p /= sum;
        const double angle = 2 * std::numbers::pi * share(random);
        const Vec2 near = p + (epsilon + inset) * Vec2(std::cos(angle), std::sin(angle));
        EXPECT_TRUE(looks_up(blocks, p, height)) << i << " " << s;
        EXPECT_TRUE(looks_up(blocks, near, height)) << i << " " << s;
        smaller += looks_up(blocks, p + 1.2 * (near - p), height) ? 0 : 1;
        for (std::size_t t = 0; t < s; ++t)
          EXPECT_FALSE(std::abs(found[t].front().z() - height) < 1e-9 && depth(found[t], p) > 1e-7)
              << i << " " << s << " " << t;
      }
    }
  }
  EXPECT_GT(surfaces, 200U);
  EXPECT_GT(smaller, 100U);  // and no smaller than that
}

TEST(UpperSurfaces, LeaveOutNothing) {
  std::mt19937_64 random(12);
  std::size_t seen = 0;
  for (int i = 0; i < 100; ++i) {
    const std::vector<Block> blocks = random_blocks(random);
    const std::vector<std::vector<Vec3>> found =
        surfaces_of(standing(blocks, {}, 0), {}, {.most = 1000});
    for (const Block& block : blocks)
      for (double x = block.low.x() + 0.013; x < block.high.x(); x += 0.025)
        for (double y = block.low.y() + 0.017; y < block.high.y(); y += 0.025) {
          if (!looks_up(blocks, {x, y}, block.high.z())) continue;
          ++seen;
          EXPECT_TRUE(std::ranges::any_of(found,
                                          [&](const std::vector<Vec3>& outline) {
                                            return std::abs(outline.front().z() - block.high.z()) <
                                                       1e-9 &&
                                                   depth(outline, {x, y}) > -1e-9;
                                          }))
              << i << " " << x << " " << y << " " << block.high.z();
        }
  }
  EXPECT_GT(seen, 10000U);
}

TEST(UpperSurfaces, AreOneWhereTheUnionIsConvex) {
  const auto block = [](double x, double y, double to_x, double to_y) {
    return Block{{x, y, 0}, {to_x, to_y, 1}};
  };
  const auto count = [&](const std::vector<Block>& blocks) {
    return surfaces_of(standing(blocks, {}, 0), {}, {}).size();
  };
  EXPECT_EQ(count({block(0, 0, 1, 1), block(1, 0, 2, 1), block(0, 1, 1, 2), block(1, 1, 2, 2)}),
            1U);
  EXPECT_EQ(count({block(0, 0, 1, 1), block(1, 0, 2, 1), block(0, 1, 1, 2)}), 2U);  // an L
  EXPECT_EQ(count({block(0, 0, 1, 1), block(1.001, 0, 2, 1)}), 2U);                 // a slot
  EXPECT_EQ(count({block(0, 0, 1.5, 1), block(1, 0, 2, 1)}), 1U);
  // No two of these five have a convex union.
  EXPECT_EQ(count({block(0, 0, 2, 1), block(2, 0, 3, 2), block(1, 2, 3, 3), block(0, 1, 1, 3),
                   block(1, 1, 2, 2)}),
            1U);
  // A millionth of the size higher is another plane.
  EXPECT_EQ(count({block(0, 0, 1, 1), {{1, 0, 0}, {2, 1, 1.00001}}}), 2U);
}

TEST(UpperSurfaces, OfContainersAreTheirFloors) {
  // A crate on whose floor the walls stand, and a wall across.
  const std::vector<Block> crate{
      {{0, 0, 0}, {1, 2, 0.1}},    {{0, 0, 0.05}, {0.1, 2, 1}},
      {{0.9, 0, 0.05}, {1, 2, 1}}, {{0, 0, 0.05}, {1, 0.1, 1}},
      {{0, 1.9, 0.05}, {1, 2, 1}}, {{0.05, 0.95, 0.1}, {0.95, 1.05, 0.5}}};
  const world::World world = standing(crate, {}, 0.02);
  std::vector<std::vector<Vec3>> floors;
  for (const std::vector<Vec3>& outline : surfaces_of(world, {}, {.most = 100}))
    if (std::abs(outline.front().z() - 0.1) < 1e-9) floors.push_back(outline);
  ASSERT_EQ(floors.size(), 2U);
  for (const std::vector<Vec3>& floor : floors) EXPECT_NEAR(area_seen(floor), 0.76 * 0.81, 1e-9);
  // The middle of the floor is covered: points are in the middle of both compartments.
  std::size_t points = 0;
  for (const world::Feature& feature : derive_places(world, 0, {.most = 100})) {
    if (feature.kind != world::Feature::Kind::Point || feature.name == "bottom" ||
        std::abs(feature.point.z() - 0.1) > 1e-9)
      continue;
    ++points;
    EXPECT_NEAR(feature.point.x(), 0.5, 1e-9);
    EXPECT_NEAR(std::abs(feature.point.y() - 1), 0.475, 1e-9);
  }
  EXPECT_EQ(points, 2U);
}

TEST(UpperSurfaces, OfManyBodiesAreFew) {
  // A tray of 256 tiles in any order, with walls across that make 16 compartments.
  std::vector<Block> blocks;
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y) blocks.push_back({{1.0 * x, 1.0 * y, 0}, {x + 1.0, y + 1.0, 0.1}});
  std::mt19937_64 random(13);
  std::ranges::shuffle(blocks, random);
  for (int k = 0; k <= 4; ++k) {
    blocks.push_back({{4.0 * k - 0.1, 0, 0.05}, {4.0 * k + 0.1, 16, 1}});
    blocks.push_back({{0, 4.0 * k - 0.1, 0.05}, {16, 4.0 * k + 0.1, 1}});
  }
  std::size_t floors = 0;
  for (const std::vector<Vec3>& outline :
       surfaces_of(standing(blocks, {}, 0.01), {}, {.most = 100})) {
    if (std::abs(outline.front().z() - 0.1) > 1e-9) continue;
    ++floors;
    EXPECT_NEAR(area_seen(outline), 3.78 * 3.78, 1e-9);
  }
  EXPECT_EQ(floors, 16U);
}

TEST(UpperSurfaces, OfTopsAreLevelWithinEpsilon) {
  // A plate whose upper corners are not of one height.
  const auto plate = [](double lower, double epsilon) {
    const Block box{{-1, -1, 0}, {1, 1, 0.2}};
    world::World world = world_with({box}, 9, {}, epsilon);
    std::vector<Vec3> corners = hull_of(box, {}).vertices;
    for (Vec3& corner : corners)
      if (corner.z() > 0.1 && corner.x() * corner.y() > 0) corner.z() -= lower;
    world.objects[0].outer = {
        {{"plate", *geom::convex_hull(corners)}}, collide::Direction::Outer, epsilon};
    return derive_places(world, 0, {});
  };
  const std::vector<world::Feature> found = plate(0.019, 0.02);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_LT((found[1].point - Vec3(0, 0, 0.2)).norm(), 1e-12);
  ASSERT_EQ(found[2].outline.size(), 4U);
  for (const Vec3& corner : found[2].outline)
    EXPECT_LT((corner.cwiseAbs() - Vec3(0.98, 0.98, 0.2)).norm(), 1e-9);
  EXPECT_EQ(plate(0.021, 0.02).size(), 1U);  // the bottom alone
  EXPECT_EQ(plate(0.019, 0).size(), 1U);
  // Not what is level at its highest only: a pyramid without its tip.
  std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  for (int i = 0; i < 4; ++i)
    corners.emplace_back(0.5 * corners[static_cast<std::size_t>(i)] +
                         Vec3(0, 0, i % 2 == 0 ? 1 : 0.99));
  world::World world = world_with({{{0, 0, 0}, {1, 1, 1}}}, 9);
  world.objects[0].outer = {
      {{"stump", *geom::convex_hull(corners)}}, collide::Direction::Outer, 0.02};
  EXPECT_EQ(derive_places(world, 0, {}).size(), 1U);
}

TEST(UpperSurfaces, HaveNamesOfTheirOwn) {
  world::World world = world_with({{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 0.5}}}, 9);
  world.objects[0].features.push_back({"face", world::Feature::Kind::Plane});
  std::vector<std::string> names;
  for (const world::Feature& feature : derive_places(world, 0, {})) names.push_back(feature.name);
  EXPECT_EQ(names, (std::vector<std::string>{"bottom", "top", "top2", "face2", "face3"}));
}

TEST(UpperSurfaces, HaveNoMoreCornersThanScenesTake) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 3000; ++i)
    for (const double z : {0.0, 1.0})
      corners.emplace_back(std::cos(2 * std::numbers::pi * i / 3000),
                           std::sin(2 * std::numbers::pi * i / 3000), z);
  world::World world = world_with({{{0, 0, 0}, {1, 1, 1}}}, 9);
  world.objects[0].outer = {{{"disc", *geom::convex_hull(corners)}}, collide::Direction::Outer, 0};
  const world::Feature face = derive_places(world, 0, {}).back();
  ASSERT_EQ(face.kind, world::Feature::Kind::Surface);
  EXPECT_LE(face.outline.size(), 256U);
  EXPECT_GT(area_seen(face.outline), 3.14);
  for (const Vec3& corner : face.outline) EXPECT_LE(corner.head<2>().norm(), 1 + 1e-12);
}

}  // namespace
}  // namespace kaboum::scene
