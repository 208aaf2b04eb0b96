// Things in FCL: convex bodies by libccd, triangles in trees of oriented boxes.

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/turned_box.h>

#include <vector>

#include "adapters.h"

namespace kaboum::engines {
namespace {

fcl::Transform3d transform_of(const geom::Transform& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.linear;
  t.translation() = pose.translation;
  return t;
}

class FclCollider : public Collider {
 public:
  explicit FclCollider(std::size_t things) : things_(things) {}

  void add(std::size_t thing, const geom::ConvexBody& body) override {
    const geom::Mesh hull = geom::surface_of(body);
    const auto faces = std::make_shared<std::vector<int>>();
    for (const geom::Triangle& t : hull.triangles) {
      faces->push_back(3);
      for (const std::uint32_t v : t) faces->push_back(static_cast<int>(v));
    }
    things_[thing].bodies.push_back(
        {std::make_shared<fcl::Convexd>(
             std::make_shared<const std::vector<fcl::Vector3d>>(hull.vertices),
             static_cast<int>(hull.triangles.size()), faces),
         {geom::bounding_box(hull), {}}});
  }

  void add(std::size_t thing, const geom::Mesh& mesh) override {
    const auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    std::vector<fcl::Triangle> triangles;
    for (const geom::Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model->beginModel();
    model->addSubModel(mesh.vertices, triangles);
    model->endModel();
    things_[thing].bodies.push_back({model, {geom::bounding_box(mesh), {}}});
  }

  void put(std::size_t thing, const geom::Transform& pose) override {
    Thing& t = things_[thing];
    t.pose = transform_of(pose);
    // FCL's own box of an object that is turned is that of a ball round it: ours are tighter.
    for (Body& body : t.bodies) body.box.put(pose);
  }

  bool meet(std::size_t a, std::size_t b) override {
    for (const Body& x : things_[a].bodies)
      for (const Body& y : things_[b].bodies) {
        if (!x.box.meets(y.box)) continue;
        fcl::CollisionResultd result;
        if (fcl::collide(x.shape.get(), things_[a].pose, y.shape.get(), things_[b].pose, request_,
                         result) > 0)
          return true;
      }
    return false;
  }

 private:
  struct Body {
    std::shared_ptr<const fcl::CollisionGeometryd> shape;
    geom::TurnedBox box;
  };
  struct Thing {
    std::vector<Body> bodies;
    fcl::Transform3d pose = fcl::Transform3d::Identity();
  };

  std::vector<Thing> things_;
  const fcl::CollisionRequestd request_;
};

}  // namespace

std::unique_ptr<Collider> make_fcl_collider(std::size_t things) {
  return std::make_unique<FclCollider>(things);
}

std::string fcl_version() { return std::string("FCL ") + FCL_VERSION + " with libccd"; }

}  // namespace kaboum::engines
