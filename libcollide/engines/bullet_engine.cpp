// Bullet behind the interface of engines, to compare with.

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <limits>

#include "engine.h"

namespace kaboum::collide {
namespace {

/// Bullet's units in one of the model's: its GJK has constants with a unit, which bodies of less
/// than 0.05 units are too small for (docs/algorithms/collision-engines.md).
double scale_of(const Model& model) {
  double smallest = std::numeric_limits<double>::infinity();
  const auto look = [&](const geom::Mesh& mesh) {
    const geom::Box3 box = geom::bounding_box(mesh);
    if (const double size = (box.max - box.min).maxCoeff(); size > 0)
      smallest = std::min(smallest, size);
  };
  for (const Part& part : model.robot) look(part.mesh);
  for (const geom::Mesh& mesh : model.scene) look(mesh);
  return std::clamp(10 / smallest, 1e-4, 1e4);
}

/// Asks convex pairs for their distance alone. A simulation asks how deep they are in each other,
/// too, which takes most of the time and sometimes fails (docs/algorithms/collision-engines.md).
class Dispatcher : public btCollisionDispatcher {
 public:
  explicit Dispatcher(btCollisionConfiguration* configuration)
      : btCollisionDispatcher(configuration) {
    setNearCallback(look_at);
  }

  bool found = false;  ///< a contact of two hulls; the other pairs are left out then

 private:
  static const btConvexHullShape* hull_of(const btCollisionObject& object) {
    const btCollisionShape* shape = object.getCollisionShape();
    return shape->getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE
               ? static_cast<const btConvexHullShape*>(shape)
               : nullptr;
  }

  static void look_at(btBroadphasePair& pair, btCollisionDispatcher& dispatcher,
                      const btDispatcherInfo& info) {
    bool& found = static_cast<Dispatcher&>(dispatcher).found;
    if (found) return;
    const auto& a = *static_cast<const btCollisionObject*>(pair.m_pProxy0->m_clientObject);
    const auto& b = *static_cast<const btCollisionObject*>(pair.m_pProxy1->m_clientObject);
    const btConvexHullShape *x = hull_of(a), *y = hull_of(b);
    if (x == nullptr || y == nullptr) {
      defaultNearCallback(pair, dispatcher, info);
      return;
    }
    const btTransform &at_x = a.getWorldTransform(), &at_y = b.getWorldTransform();
    btGjkEpaSolver2::sResults results;  // without margins
    found = !btGjkEpaSolver2::Distance(x, at_x, y, at_y, at_y.getOrigin() - at_x.getOrigin(),
                                       results) ||
            results.distance <= x->getMargin() + y->getMargin();
  }
};

/// Convex parts by GJK, triangles of the robot by GImpact, all behind a tree of boxes.
class BulletEngine : public Engine {
 public:
  explicit BulletEngine(const Model& model)
      : scale_(scale_of(model)),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &configuration_) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    for (const Part& part : model.robot) {
      links_.push_back(part.link);
      robot_.push_back(add(part.mesh, model.convex, model.margin, kRobot, kScene));
    }
    for (const geom::Mesh& mesh : model.scene) add(mesh, true, 0, kScene, kRobot);
  }

  ~BulletEngine() override {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }
  BulletEngine(const BulletEngine&) = delete;
  BulletEngine& operator=(const BulletEngine&) = delete;

  void place(const std::vector<geom::Transform>& poses) override {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const geom::Transform& pose = poses[links_[i]];
      btMatrix3x3 basis;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) basis[r][c] = static_cast<btScalar>(pose.linear(r, c));
      robot_[i]->setWorldTransform(btTransform(basis, vector_of(pose.translation)));
    }
  }

  bool collide() override {
    dispatcher_.found = false;
    world_.performDiscreteCollisionDetection();
    if (dispatcher_.found) return true;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(i);
      for (int k = 0; k < manifold->getNumContacts(); ++k)
        if (manifold->getContactPoint(k).getDistance() <= 0) return true;
    }
    return false;
  }

  double distance() override { return std::numeric_limits<double>::quiet_NaN(); }

 private:
  static constexpr int kRobot = 1, kScene = 2;

  [[nodiscard]] btVector3 vector_of(const geom::Vec3& v) const {
    return {static_cast<btScalar>(scale_ * v.x()), static_cast<btScalar>(scale_ * v.y()),
            static_cast<btScalar>(scale_ * v.z())};
  }

  btCollisionObject* add(const geom::Mesh& mesh, bool convex, double margin, int group, int mask) {
    if (convex) {
      auto shape = std::make_unique<btConvexHullShape>();
      for (const geom::Vec3& v : mesh.vertices) shape->addPoint(vector_of(v), false);
      shape->setMargin(static_cast<btScalar>(scale_ * margin));  // first: the box has it
      shape->recalcLocalAabb();
      shapes_.push_back(std::move(shape));
    } else {
      auto triangles = std::make_unique<btTriangleMesh>();
      for (const geom::Triangle& t : mesh.triangles)
        triangles->addTriangle(vector_of(mesh.vertices[t[0]]), vector_of(mesh.vertices[t[1]]),
                               vector_of(mesh.vertices[t[2]]));
      auto shape = std::make_unique<btGImpactMeshShape>(triangles.get());
      shape->setMargin(0);
      shape->updateBound();
      triangles_.push_back(std::move(triangles));
      shapes_.push_back(std::move(shape));
    }
    auto object = std::make_unique<btCollisionObject>();
    object->setCollisionShape(shapes_.back().get());
    object->setWorldTransform(btTransform::getIdentity());
    world_.addCollisionObject(object.get(), group, mask);
    objects_.push_back(std::move(object));
    return objects_.back().get();
  }

  double scale_;
  std::vector<std::unique_ptr<btTriangleMesh>> triangles_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  btDefaultCollisionConfiguration configuration_;
  Dispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_;
  std::vector<std::uint32_t> links_;
  std::vector<btCollisionObject*> robot_;
};

}  // namespace

std::unique_ptr<Engine> make_bullet(const Model& model) {
  return std::make_unique<BulletEngine>(model);
}

}  // namespace kaboum::collide
