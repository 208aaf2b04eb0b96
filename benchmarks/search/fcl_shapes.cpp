// Shapes in FCL: trees of oriented boxes over triangles, or convex bodies.
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl_geometry.h>

#include "other_world.h"

namespace kaboum::search {
namespace {

class FclShapes : public Shapes {
 public:
  FclShapes(std::size_t things, bool convex) : convex_(convex), shapes_(things) {}

  void add(std::size_t thing, const geom::Mesh& mesh) override {
    shapes_[thing].push_back(
        std::make_unique<fcl::CollisionObjectd>(collide::fcl_geometry(mesh, convex_)));
  }

  void put(std::size_t thing, const geom::Transform& pose) override {
    fcl::Transform3d t = fcl::Transform3d::Identity();
    t.linear() = pose.linear;
    t.translation() = pose.translation;
    for (const auto& shape : shapes_[thing]) {
      shape->setTransform(t);
      shape->computeAABB();
    }
  }

  bool meet(std::size_t a, std::size_t b) override {
    const fcl::CollisionRequestd request;
    for (const auto& x : shapes_[a])
      for (const auto& y : shapes_[b]) {
        if (!x->getAABB().overlap(y->getAABB())) continue;
        fcl::CollisionResultd result;
        if (fcl::collide(x.get(), y.get(), request, result) > 0) return true;
      }
    return false;
  }

 private:
  bool convex_;
  std::vector<std::vector<std::unique_ptr<fcl::CollisionObjectd>>> shapes_;
};

}  // namespace

std::unique_ptr<Shapes> fcl_shapes(std::size_t things, bool convex) {
  return std::make_unique<FclShapes>(things, convex);
}

}  // namespace kaboum::search
