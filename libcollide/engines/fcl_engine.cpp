// FCL behind the interface of engines, to compare with.

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include "engine.h"

namespace kaboum::collide {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

Geometry geometry_of(const geom::Mesh& mesh, bool convex) {
  if (convex) {
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>(mesh.vertices);
    auto faces = std::make_shared<std::vector<int>>();
    for (const geom::Triangle& t : mesh.triangles) {
      faces->push_back(3);
      for (const std::uint32_t v : t) faces->push_back(static_cast<int>(v));
    }
    return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(mesh.triangles.size()), faces);
  }
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const geom::Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

/// libccd as the narrow phase of convex parts: FCL's default.
class FclEngine : public Engine {
 public:
  explicit FclEngine(const Model& model) : margin_(model.margin) {
    for (const Part& part : model.robot) {
      links_.push_back(part.link);
      robot_objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(geometry_of(part.mesh, model.convex)));
      robot_.registerObject(robot_objects_.back().get());
    }
    for (const geom::Mesh& mesh : model.scene) {
      scene_objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(geometry_of(mesh, model.convex)));
      scene_objects_.back()->computeAABB();
      scene_.registerObject(scene_objects_.back().get());
    }
    robot_.setup();
    scene_.setup();
  }

  void place(const std::vector<geom::Transform>& poses) override {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const geom::Transform& pose = poses[links_[i]];
      fcl::Transform3d t = fcl::Transform3d::Identity();
      t.linear() = pose.linear;
      t.translation() = pose.translation;
      robot_objects_[i]->setTransform(t);
      robot_objects_[i]->computeAABB();
    }
    robot_.update();
  }

  bool collide() override {
    if (margin_ > 0) return distance() <= margin_;
    fcl::DefaultCollisionData<double> data;
    robot_.collide(&scene_, &data, fcl::DefaultCollisionFunction<double>);
    return data.result.isCollision();
  }

  double distance() override {
    fcl::DefaultDistanceData<double> data;
    robot_.distance(&scene_, &data, fcl::DefaultDistanceFunction<double>);
    return data.result.min_distance;
  }

 private:
  double margin_;
  std::vector<std::uint32_t> links_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> robot_objects_, scene_objects_;
  fcl::DynamicAABBTreeCollisionManagerd robot_, scene_;
};

}  // namespace

std::unique_ptr<Engine> make_fcl(const Model& model) { return std::make_unique<FclEngine>(model); }

}  // namespace kaboum::collide
