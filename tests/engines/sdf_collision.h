#pragma once

#include <gtest/gtest.h>
#include <sdf/sdf.hh>

#include <filesystem>
#include <string>

#include "expected.h"

/// What libsdformat has read, in the terms of expected.h.
namespace engines {

inline Eigen::Isometry3d isometry(const ignition::math::Pose3d& pose) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  const auto& q = pose.Rot();
  out.linear() = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).toRotationMatrix();
  out.translation() = Eigen::Vector3d(pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z());
  return out;
}

inline Eigen::Vector3d vector(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

inline Measure measure_collision(const sdf::Collision& collision,
                                 const std::filesystem::path& folder, const std::string& prefix) {
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

}  // namespace engines
