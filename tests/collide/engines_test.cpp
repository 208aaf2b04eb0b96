// The engines behind one interface say the same as the oracle of separation_test.cpp, away from
// contact. (Not ODE: its scenes are boxes.)

#include <gtest/gtest.h>

#include "engine.h"
#include "pairs.h"

namespace kaboum::collide {
namespace {

/// The body, larger or smaller about its middle: engines have tolerances.
std::vector<geom::Vec3> scaled(const geom::Mesh& body, double factor) {
  geom::Vec3 center = geom::Vec3::Zero();
  for (const geom::Vec3& v : body.vertices) center += v / static_cast<double>(body.vertices.size());
  std::vector<geom::Vec3> out;
  for (const geom::Vec3& v : body.vertices) out.emplace_back(center + factor * (v - center));
  return out;
}

TEST(Engines, SayWhatTheOracleSays) {
  const std::vector<std::pair<const char*, std::unique_ptr<Engine> (*)(const Model&)>> engines{
      {"FCL", make_fcl},
      {"Bullet", make_bullet},
      {"tree, FCL with libccd", make_fcl_tree},
      {"tree, FCL's own GJK", make_fcl_own_tree},
      {"tree, libccd", make_ccd_tree},
      {"tree, directions, FCL", make_fcl_directions},
      {"tree, directions, libccd", make_ccd_directions}};
  std::mt19937_64 random(5);
  int meeting = 0, apart = 0;
  for (int i = 0; i < 300; ++i) {
    const double size = i % 2 == 0 ? 1 : 0.03;  // parts of centimetres in metres
    const auto random_body = [&] {
      geom::Mesh body = test::random_body(random, 1);
      for (geom::Vec3& v : body.vertices) v *= size;
      return body;
    };
    Model model{"bodies", true, 0, {}, {}};
    for (int k = 0; k < 3; ++k) model.robot.push_back({0, random_body()});
    for (int k = 0; k < 3; ++k) model.scene.push_back(random_body());
    geom::Transform pose = test::random_pose(random, 1);
    pose.translation *= size;
    const auto any = [&](double factor) {
      for (const Part& part : model.robot)
        for (const geom::Mesh& body : model.scene)
          if (test::meet(scaled(body, factor), scaled(part.mesh, factor), pose)) return true;
      return false;
    };
    const bool surely = any(0.8), perhaps = any(1.25);
    if (surely != perhaps) continue;
    (surely ? meeting : apart) += 1;
    for (const auto& [name, make] : engines) {
      const auto engine = make(model);
      engine->place({pose});
      EXPECT_EQ(engine->collide(), surely) << name << ", " << i;
    }
  }
  EXPECT_GT(meeting, 10);
  EXPECT_GT(apart, 10);
}

}  // namespace
}  // namespace kaboum::collide
