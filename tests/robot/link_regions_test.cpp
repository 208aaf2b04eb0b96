// Regions of robots: which links they are of, and where they come to lie in the frames of these and
// of their meshes, however turned and scaled.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/io/region_file.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/link_regions.h>

#include <random>

namespace kaboum::test {
namespace {

using geom::Vec3;
using robot::Geometry;
using robot::Side;

constexpr const char* kHand = R"(<robot name="r">
  <link name="arm"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="flange"/>
  <link name="hand"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="tip"/>
  <link name="finger"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="float"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="sensor"/>
  <joint name="turn" type="revolute"><parent link="arm"/><child link="flange"/>
    <origin xyz="0 0 1" rpy="0.3 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="mount" type="fixed"><parent link="flange"/><child link="hand"/>
    <origin xyz="0.1 -0.2 0.3" rpy="0.7 -0.4 1.1"/></joint>
  <joint name="end" type="fixed"><parent link="hand"/><child link="tip"/>
    <origin xyz="0.05 0.02 0.6" rpy="-0.2 0.9 2"/></joint>
  <joint name="slide" type="prismatic"><parent link="hand"/><child link="finger"/>
    <origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="loose" type="floating"><parent link="hand"/><child link="float"/></joint>
  <joint name="eye" type="fixed"><parent link="float"/><child link="sensor"/></joint>
</robot>)";

robot::RobotFile file_of(const char* text) {
  robot::RobotFile out;
  out.robot = robot::parse_urdf(text, "r.urdf");
  out.path = "r.urdf";
  return out;
}

robot::LinkBounds bounds_of(const std::string& regions, const robot::ShapeChoice& choice = {}) {
  return robot::bounds_of_links(
      file_of(kHand), choice,
      io::parse_frame_regions("{\"regions\": [" + regions + "]}", "map.json"));
}

std::string refusal(const std::string& regions, const robot::ShapeChoice& choice = {}) {
  try {
    bounds_of(regions, choice);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "no error";
}

std::vector<std::string> links_of(const std::string& regions) {
  std::vector<std::string> out;
  for (const auto& [link, own] : bounds_of(regions).regions) out.push_back(link);
  return out;
}

TEST(LinkRegions, AreOfTheLinksThatNoJointMovesAgainstTheirFrame) {
  using Names = std::vector<std::string>;
  for (const char* frame : {"tip", "hand", "flange"})
    EXPECT_EQ(links_of(std::string(R"({"frame": ")") + frame + R"(", "radius": 1, "epsilon": 1})"),
              Names{"hand"});
  EXPECT_EQ(links_of(R"({"frame": "finger", "radius": 1, "epsilon": 1})"), Names{"finger"});
  EXPECT_EQ(links_of(R"({"frame": "arm", "radius": 1, "epsilon": 1})"), Names{"arm"});
  // What floats moves, though its joint is fixed here.
  EXPECT_EQ(links_of(R"({"frame": "sensor", "radius": 1, "epsilon": 1})"), Names{"float"});
}

TEST(LinkRegions, RefusalsNameThePlace) {
  EXPECT_EQ(refusal(R"({"frame": "arm", "radius": 1, "epsilon": 1},
                       {"frame": "hant", "radius": 1, "epsilon": 1})"),
            "map.json: region 2: robot 'r' has no frame 'hant'; did you mean 'hand'?");
  EXPECT_EQ(refusal(R"({"link": "fingr", "epsilon": 1})"),
            "map.json: region 1: robot 'r' has no link 'fingr'; did you mean 'finger'?");
  EXPECT_TRUE(refusal(R"({"link": "tip", "epsilon": 1})").starts_with("map.json: region 1: link"));
  EXPECT_TRUE(refusal(R"({"link": "arm", "epsilon": 1}, {"link": "arm", "epsilon": 2})")
                  .starts_with("map.json: region 2: link 'arm' has an epsilon already"));
  robot::ShapeChoice arm;
  arm.links = {"arm"};
  EXPECT_TRUE(
      refusal(R"({"frame": "tip", "radius": 1, "epsilon": 1})", arm)
          .starts_with("map.json: region 1: no shape that is meant is fixed to frame 'tip'"));
}

/// A point that is spread about the origin.
Vec3 random_point(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> along(-size, size);
  return {along(random), along(random), along(random)};
}

/// By how much a point is within; below 0: outside. In rounded numbers.
double depth(const geom::Region& region, const Vec3& p) {
  if (region.sides.empty()) return region.radius - (p - region.center).norm();
  double out = std::numeric_limits<double>::infinity();
  for (const geom::HalfSpace& side : region.sides)
    out = std::min(out, side.offset - side.normal.dot(p));
  return out;
}

// Poses by forward kinematics, which composes them in another order.
TEST(LinkRegions, MoveWithTheirFrames) {
  const robot::RobotFile file = file_of(kHand);
  const std::vector<robot::Transform> poses = robot::forward(file.robot, std::array{0.0, 0.0});
  const auto tip = *file.robot.find_link("tip"), hand = *file.robot.find_link("hand");
  std::mt19937_64 random(1);
  for (const char* shape : {R"("ball": {"center": [0.1, 0.2, -0.1], "radius": 0.4})",
                            R"("box": [[-0.1, -0.2, -0.3], [0.3, 0.2, 0.4]])",
                            R"("half_space": {"normal": [1, -2, 0.5], "offset": 0.1})"}) {
    const std::string text = std::string(R"({"frame": "tip", "epsilon": 1, )") + shape + "}";
    const geom::Region asked =
        io::parse_frame_regions("{\"regions\": [" + text + "]}", "map").regions[0].region;
    const robot::LinkBounds bounds = bounds_of(text);
    const robot::LinkRegion& moved = bounds.regions.at("hand").at(0);
    EXPECT_GT(moved.rounding, 0);
    int held = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = random_point(random, 0.6);
      const Vec3 in_world = poses[tip] * p,
                 in_hand = poses[hand].linear.transpose() * (in_world - poses[hand].translation);
      EXPECT_NEAR(depth(asked, p), depth(moved.region, in_hand), 1e-14);
      held += geom::holds(asked, p) ? 1 : 0;
    }
    EXPECT_GT(held, 20);
    EXPECT_LT(held, 1980);
  }
}

// A mesh's frame is turned, far away, mirrored and stretched: what is round holds all that is
// asked for, what is within nothing else; of even scales both are the same up to rounding.
TEST(LinkRegions, StandForWhatIsAskedForInFramesOfMeshes) {
  std::mt19937_64 random(2);
  for (const Vec3& scale : {Vec3(1, 1, 1), Vec3(0.001, -0.001, 0.001), Vec3(0.5, 2, -1)})
    for (const double far : {0.0, 3.0, 1000.0}) {
      Geometry g;
      g.shape = Geometry::Shape::Mesh;
      g.size = scale;
      g.origin.linear = robot::rotation_from_rpy(0.4, -1.1, 2.3);
      g.origin.translation = Vec3(far, -2 * far, 0.5 * far);
      const bool is_even = scale.cwiseAbs().maxCoeff() == scale.cwiseAbs().minCoeff();
      geom::Region ball, half_space;
      ball.center = g.origin.translation + Vec3(0.1, 0.2, 0.3);
      ball.radius = 0.5;
      half_space.sides = {{Vec3(1, 2, -2) / 3, Vec3(1, 2, -2).dot(g.origin.translation) / 3 + 0.1}};
      geom::Region box =
          geom::box_region({ball.center - Vec3(0.3, 0.5, 0.2), ball.center + Vec3(0.4, 0.1, 0.6)});
      for (const geom::Region& region : {ball, half_space, box}) {
        robot::LinkRegion asked;
        asked.region = region;
        asked.epsilon = Length{0.01};
        const auto round = robot::region_in_shape(asked, g, Side::Round),
                   within = robot::region_in_shape(asked, g, Side::Within);
        ASSERT_TRUE(round && within);
        EXPECT_EQ(round->epsilon.value, 0.01 / scale.cwiseAbs().maxCoeff());
        EXPECT_EQ(within->epsilon.value, 0.01 / scale.cwiseAbs().minCoeff());
        const auto asked_at = [&](const Vec3& local) {  // in the link's directions
          return depth(region, g.origin.translation + local);
        };
        const auto in_mesh = [&](const Vec3& local) {
          return Vec3((g.origin.linear.transpose() * local).cwiseQuotient(scale));
        };
        std::vector<Vec3> inside, outside;
        const double slack = 1e-15 * (1 + 4 * far);  // what rounding of this test takes
        for (int i = 0; i < 2000; ++i) {
          const Vec3 local = random_point(random, 1);
          const double asked_depth = asked_at(local);
          (asked_depth > slack ? inside : outside).push_back(local);
          const double of_round = depth(round->region, in_mesh(local)),
                       of_within = depth(within->region, in_mesh(local));
          EXPECT_TRUE(!(asked_depth > slack) || of_round >= 0);
          EXPECT_TRUE(!(asked_depth < -slack) || of_within <= 0);
          if (!is_even) continue;
          const double size = std::abs(scale.x());
          EXPECT_NEAR(size * of_round, asked_depth, 1e-12 * (1 + far));
          EXPECT_NEAR(size * of_within, asked_depth, 1e-12 * (1 + far));
        }
        ASSERT_GT(inside.size(), 20U);
        // On the boundary, as far as it is known: one is certainly beyond it, the other is not.
        for (std::size_t i = 0; i < 20; ++i) {
          Vec3 in = inside[i], out = outside[i];
          for (int step = 0; step < 60; ++step) {
            const Vec3 middle = 0.5 * (in + out);
            (asked_at(middle) > 0 ? in : out) = middle;
          }
          EXPECT_GT(depth(round->region, in_mesh(in)), 0);
          EXPECT_LT(depth(within->region, in_mesh(in)), 0);
        }
      }
    }
}

TEST(LinkRegions, PlanesThatCannotBeToldApartAreRefused) {
  Geometry g;
  g.shape = Geometry::Shape::Mesh;
  g.size = {1, 1, 1e-3};
  g.origin.linear = robot::rotation_from_rpy(0.4, -1.1, 2.3);
  robot::LinkRegion asked;
  asked.name = "'grip'";
  asked.epsilon = Length{0.01};
  asked.region = geom::box_region({Vec3::Zero(), Vec3::Ones()});
  EXPECT_THROW(robot::region_in_shape(asked, g, Side::Round), Error);
  g.size.z() = 0.1;
  EXPECT_TRUE(robot::region_in_shape(asked, g, Side::Round));
}

}  // namespace
}  // namespace kaboum::test
