// libsdformat, which Gazebo reads robots with, finds the bodies of the outputs where they are.

#include <gtest/gtest.h>
#include <sdf/sdf.hh>

#include "expected.h"

namespace engines {
namespace {

Eigen::Isometry3d isometry(const ignition::math::Pose3d& pose) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  const auto& q = pose.Rot();
  out.linear() = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).toRotationMatrix();
  out.translation() = Eigen::Vector3d(pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z());
  return out;
}

Eigen::Vector3d vector(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

Measure measure_collision(const sdf::Collision& collision, const std::filesystem::path& folder,
                          const std::string& prefix) {
  ignition::math::Pose3d raw;
  EXPECT_TRUE(collision.SemanticPose().Resolve(raw, "__model__").empty()) << collision.Name();
  const Eigen::Isometry3d pose = isometry(raw);
  const sdf::Geometry& g = *collision.Geom();
  if (const sdf::Box* box = g.BoxShape()) return measure_box(pose, vector(box->Size()));
  if (const sdf::Cylinder* c = g.CylinderShape())
    return measure_cylinder(pose, c->Radius(), c->Length());
  if (const sdf::Sphere* sphere = g.SphereShape()) return measure_sphere(pose, sphere->Radius());
  const sdf::Mesh* mesh = g.MeshShape();
  if (mesh == nullptr) return {};
  EXPECT_TRUE(mesh->Uri().starts_with(prefix)) << mesh->Uri();
  return measure(mesh->Uri(), corners_of_stl(folder / mesh->Uri().substr(prefix.size()),
                                             vector(mesh->Scale()), pose));
}

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
