// Shapes in Bullet: triangles by GImpact, or convex bodies by GJK.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include "other_world.h"

namespace kaboum::search {
namespace {

btVector3 vector_of(const geom::Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// Whether a contact was found.
class Contact : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  bool found = false;
  void addContactPoint(const btVector3&, const btVector3&, btScalar distance) override {
    found = found || distance <= 0;
  }
};

btCollisionObjectWrapper wrapped(const btCollisionObject& object) {
  return {nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1};
}

class BulletShapes : public Shapes {
 public:
  BulletShapes(std::size_t things, bool convex)
      : convex_(convex), shapes_(things), dispatcher_(&configuration_) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
  }

  void add(std::size_t thing, const geom::Mesh& mesh) override {
    forms_.push_back(convex_ ? hull_of(mesh) : triangles_of(mesh));
    auto object = std::make_unique<btCollisionObject>();
    object->setCollisionShape(forms_.back().get());
    object->setWorldTransform(btTransform::getIdentity());
    shapes_[thing].push_back(std::move(object));
  }

  void put(std::size_t thing, const geom::Transform& pose) override {
    btMatrix3x3 basis;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) basis[r][c] = static_cast<btScalar>(pose.linear(r, c));
    for (const auto& shape : shapes_[thing])
      shape->setWorldTransform(btTransform(basis, vector_of(pose.translation)));
  }

  bool meet(std::size_t a, std::size_t b) override {
    for (const auto& x : shapes_[a])
      for (const auto& y : shapes_[b]) {
        btVector3 low_x, high_x, low_y, high_y;
        x->getCollisionShape()->getAabb(x->getWorldTransform(), low_x, high_x);
        y->getCollisionShape()->getAabb(y->getWorldTransform(), low_y, high_y);
        if (!TestAabbAgainstAabb2(low_x, high_x, low_y, high_y)) continue;
        if (touch(*x, *y)) return true;
      }
    return false;
  }

 private:
  /// As in a simulation: btCollisionWorld's test of a single pair does not know GImpact.
  bool touch(const btCollisionObject& x, const btCollisionObject& y) {
    const btCollisionObjectWrapper of_x = wrapped(x), of_y = wrapped(y);
    btCollisionAlgorithm* algorithm =
        dispatcher_.findAlgorithm(&of_x, &of_y, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    if (algorithm == nullptr) return false;
    Contact contact(&of_x, &of_y);
    algorithm->processCollision(&of_x, &of_y, info_, &contact);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return contact.found;
  }

  static std::unique_ptr<btCollisionShape> hull_of(const geom::Mesh& mesh) {
    auto shape = std::make_unique<btConvexHullShape>();
    for (const geom::Vec3& v : mesh.vertices) shape->addPoint(vector_of(v), false);
    shape->recalcLocalAabb();
    shape->setMargin(0);
    return shape;
  }

  std::unique_ptr<btCollisionShape> triangles_of(const geom::Mesh& mesh) {
    triangles_.push_back(std::make_unique<btTriangleMesh>());
    for (const geom::Triangle& t : mesh.triangles)
      triangles_.back()->addTriangle(vector_of(mesh.vertices[t[0]]), vector_of(mesh.vertices[t[1]]),
                                     vector_of(mesh.vertices[t[2]]));
    auto shape = std::make_unique<btGImpactMeshShape>(triangles_.back().get());
    shape->setMargin(0);
    shape->updateBound();
    return shape;
  }

  bool convex_;
  std::vector<std::unique_ptr<btTriangleMesh>> triangles_;
  std::vector<std::unique_ptr<btCollisionShape>> forms_;
  std::vector<std::vector<std::unique_ptr<btCollisionObject>>> shapes_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDispatcherInfo info_;
};

}  // namespace

std::unique_ptr<Shapes> bullet_shapes(std::size_t things, bool convex) {
  return std::make_unique<BulletShapes>(things, convex);
}

}  // namespace kaboum::search
