// libsdformat, which Gazebo reads robots with, finds the bodies of the outputs where they are.

#include <gtest/gtest.h>
#include <sdf/sdf.hh>

#include "expected.h"
#include "sdf_collision.h"

namespace engines {
namespace {

/// @param uri  what libsdformat makes of the prefix.
void expect_all(const std::filesystem::path& urdf, const std::string& prefix,
                const std::string& uri) {
  const Robot robot = read_urdf(urdf, prefix);
  sdf::Root root;
  for (const sdf::Error& error : root.Load(urdf.string())) ADD_FAILURE() << urdf << ": " << error;
  const sdf::Model* model = root.Model();
  ASSERT_NE(model, nullptr) << urdf;
  std::map<std::string, std::vector<Measure>> bodies;
  for (std::uint64_t l = 0; l < model->LinkCount(); ++l) {
    const sdf::Link& link = *model->LinkByIndex(l);
    ignition::math::Pose3d pose;
    EXPECT_TRUE(link.SemanticPose().Resolve(pose, "__model__").empty());
    for (const Link& known : robot.links)
      if (known.name == link.Name()) {
        EXPECT_TRUE(isometry(pose).isApprox(known.pose, 1e-6)) << urdf << ": " << known.name;
      }
    for (std::uint64_t c = 0; c < link.CollisionCount(); ++c)
      bodies[link.Name()].push_back(
          measure_collision(*link.CollisionByIndex(c), urdf.parent_path(), uri));
  }
  for (const auto& [link, measures] : bodies_by(robot, &Link::model))
    expect_same(urdf.string() + ", link '" + link + "'", measures, bodies[link]);
}

TEST(SDFormat, HasTheBodiesThatWereWritten) {
  for (const std::filesystem::path& urdf : outputs()) expect_all(urdf, "", "");
}

TEST(SDFormat, HasTheBodiesOfPackages) {
  expect_all(prefixed(), "package://cell/prefixed/", "model://cell/prefixed/");
}

}  // namespace
}  // namespace engines
