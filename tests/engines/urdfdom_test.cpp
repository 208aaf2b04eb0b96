// urdfdom, which ROS reads robots with, has the links, poses and files of the outputs.

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include "expected.h"

namespace engines {
namespace {

Eigen::Isometry3d isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  const urdf::Rotation& q = pose.rotation;
  out.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  out.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return out;
}

Eigen::Isometry3d pose_of(const urdf::Link& link) {
  if (!link.parent_joint) return Eigen::Isometry3d::Identity();
  return pose_of(*link.getParent()) * isometry(link.parent_joint->parent_to_joint_origin_transform);
}

Measure measure_geometry(const urdf::Geometry& g, const Eigen::Isometry3d& pose,
                         const std::filesystem::path& folder, const std::string& prefix) {
  const auto vector = [](const urdf::Vector3& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  switch (g.type) {
    case urdf::Geometry::BOX:
      return measure_box(pose, vector(dynamic_cast<const urdf::Box&>(g).dim));
    case urdf::Geometry::CYLINDER: {
      const auto& c = dynamic_cast<const urdf::Cylinder&>(g);
      return measure_cylinder(pose, c.radius, c.length);
    }
    case urdf::Geometry::SPHERE:
      return measure_sphere(pose, dynamic_cast<const urdf::Sphere&>(g).radius);
    default:
      break;
  }
  const auto& mesh = dynamic_cast<const urdf::Mesh&>(g);
  EXPECT_TRUE(mesh.filename.starts_with(prefix)) << mesh.filename;
  return measure(mesh.filename, corners_of_stl(folder / mesh.filename.substr(prefix.size()),
                                               vector(mesh.scale), pose));
}

void expect_all(const std::filesystem::path& urdf, const std::string& prefix) {
  const Robot robot = read_urdf(urdf, prefix);
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDFFile(urdf.string());
  ASSERT_TRUE(model) << urdf;
  EXPECT_EQ(model->links_.size(), robot.links.size());
  for (const Link& link : robot.links) {
    const urdf::LinkConstSharedPtr there = model->getLink(link.name);
    ASSERT_TRUE(there) << urdf << ": " << link.name;
    const Eigen::Isometry3d pose = pose_of(*there);
    EXPECT_TRUE(pose.isApprox(link.pose, 1e-6)) << urdf << ": " << link.name;
    std::vector<Measure> expected, loaded;
    for (const Shape& shape : link.collisions) expected.push_back(shape.measure);
    for (const urdf::CollisionSharedPtr& c : there->collision_array)
      loaded.push_back(
          measure_geometry(*c->geometry, pose * isometry(c->origin), urdf.parent_path(), prefix));
    expect_same(urdf.string() + ", link '" + link.name + "'", expected, loaded);
  }
}

TEST(Urdfdom, HasTheBodiesThatWereWritten) {
  for (const std::filesystem::path& urdf : outputs()) expect_all(urdf, "");
}

TEST(Urdfdom, HasTheBodiesOfPackages) { expect_all(prefixed(), "package://cell/prefixed/"); }

}  // namespace
}  // namespace engines
