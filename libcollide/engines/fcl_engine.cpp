// FCL behind the interface of engines, to compare with.

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>
#include <kaboum/geom/turned_box.h>

#include "engine.h"
#include "fcl_geometry.h"

namespace kaboum::collide {
namespace {

/// Leaves out pairs whose own boxes, turned, are apart: FCL's box of an object that is turned is
/// that of a ball round it (docs/algorithms/collision-engines.md).
bool collide_near(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
  const auto box = [](const fcl::CollisionObjectd& object) {
    return static_cast<const geom::TurnedBox*>(object.getUserData());
  };
  return box(*a)->meets(*box(*b)) && fcl::DefaultCollisionFunction<double>(a, b, data);
}

/// libccd as the narrow phase of convex parts: FCL's default.
class FclEngine : public Engine {
 public:
  explicit FclEngine(const Model& model)
      : margin_(model.margin), robot_boxes_(model.robot.size()), scene_boxes_(model.scene.size()) {
    for (const Part& part : model.robot) {
      geom::TurnedBox& box = robot_boxes_[links_.size()];
      box.own = geom::bounding_box(part.mesh);
      links_.push_back(part.link);
      robot_objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(fcl_geometry(part.mesh, model.convex)));
      robot_objects_.back()->setUserData(&box);
      robot_.registerObject(robot_objects_.back().get());
    }
    for (const geom::Mesh& mesh : model.scene) {
      scene_objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(fcl_geometry(mesh, model.convex)));
      geom::TurnedBox& box = scene_boxes_[scene_objects_.size() - 1];
      box.own = geom::bounding_box(mesh);
      box.put({});
      scene_objects_.back()->setUserData(&box);
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
      robot_boxes_[i].put(pose);
    }
    robot_.update();
  }

  bool collide() override {
    if (margin_ > 0) return distance() <= margin_;
    fcl::DefaultCollisionData<double> data;
    robot_.collide(&scene_, &data, collide_near);
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
  std::vector<geom::TurnedBox> robot_boxes_, scene_boxes_;  // where objects point to
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> robot_objects_, scene_objects_;
  fcl::DynamicAABBTreeCollisionManagerd robot_, scene_;
};

}  // namespace

std::unique_ptr<Engine> make_fcl(const Model& model) { return std::make_unique<FclEngine>(model); }

}  // namespace kaboum::collide
