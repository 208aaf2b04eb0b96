// Things in Bullet, in single precision: convex bodies by its GJK, triangles by GImpact.

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <btBulletCollisionCommon.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/turned_box.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "adapters.h"

namespace kaboum::engines {
namespace {

/// Bullet's units in the smallest body. Its GJK takes points less than 0.01 units from each other
/// for the same, and distances below 0.0001 for none, whatever is compared: bodies of centimetres
/// in metres are missed. Its wiki asks for such worlds to be scaled up.
constexpr double kSmallest = 10;
/// Bullet's numbers have 24 bits: what is far away is not finer for being larger.
constexpr double kMostScale = 1e4;

/// Whether a contact was found.
class Contact : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  bool found = false;
  void addContactPoint(const btVector3& /*normal*/, const btVector3& /*point*/,
                       btScalar distance) override {
    found = found || distance <= 0;
  }
};

btCollisionObjectWrapper wrapped(const btCollisionObject& object) {
  return {nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1};
}

class BulletCollider : public Collider {
 public:
  explicit BulletCollider(std::size_t things) : things_(things), dispatcher_(&configuration_) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
  }

  void add(std::size_t thing, const geom::ConvexBody& body) override {
    add(thing, geom::surface_of(body), true);
  }
  void add(std::size_t thing, const geom::Mesh& mesh) override { add(thing, mesh, false); }

  void put(std::size_t thing, const geom::Transform& pose) override {
    if (scale_ == 0) build();
    Thing& t = things_[thing];
    btMatrix3x3 basis;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) basis[r][c] = static_cast<btScalar>(pose.linear(r, c));
    t.pose = btTransform(basis, scaled(pose.translation));
    for (Body& body : t.bodies) body.box.put(pose);
  }

  bool meet(std::size_t a, std::size_t b) override {
    for (Body& x : things_[a].bodies)
      for (Body& y : things_[b].bodies) {
        if (!x.box.meets(y.box)) continue;
        if (x.convex && y.convex ? hulls_meet(*x.hull, things_[a].pose, *y.hull, things_[b].pose)
                                 : triangles_meet(x, things_[a].pose, y, things_[b].pose))
          return true;
      }
    return false;
  }

 private:
  struct Body {
    geom::Mesh mesh;
    bool convex = false;
    geom::TurnedBox box;
    std::unique_ptr<btTriangleMesh> triangles;
    std::unique_ptr<btGImpactMeshShape> surface;
    std::unique_ptr<btConvexHullShape> hull;
    std::unique_ptr<btCollisionObject> object;
  };
  struct Thing {
    std::vector<Body> bodies;
    btTransform pose = btTransform::getIdentity();
  };

  void add(std::size_t thing, const geom::Mesh& mesh, bool convex) {
    ensure(scale_ == 0, "shapes are added before things are placed");
    Body& body = things_[thing].bodies.emplace_back();
    body.mesh = mesh;
    body.convex = convex;
    body.box.own = geom::bounding_box(mesh);
  }

  [[nodiscard]] btVector3 scaled(const geom::Vec3& v) const {
    return {static_cast<btScalar>(scale_ * v.x()), static_cast<btScalar>(scale_ * v.y()),
            static_cast<btScalar>(scale_ * v.z())};
  }

  void build() {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Thing& thing : things_)
      for (const Body& body : thing.bodies)
        if (const double size = (body.box.own.max - body.box.own.min).maxCoeff(); size > 0)
          smallest = std::min(smallest, size);
    scale_ = std::clamp(kSmallest / smallest, 1 / kMostScale, kMostScale);
    for (Thing& thing : things_)
      for (Body& body : thing.bodies) build(body);
  }

  void build(Body& body) const {
    const geom::Mesh mesh = std::exchange(body.mesh, {});
    if (body.convex) {
      body.hull = std::make_unique<btConvexHullShape>();
      for (const geom::Vec3& v : mesh.vertices) body.hull->addPoint(scaled(v), false);
      body.hull->setMargin(0);  // first: its box has it
      body.hull->recalcLocalAabb();
    }
    body.object = std::make_unique<btCollisionObject>();
    if (body.convex) {
      body.object->setCollisionShape(body.hull.get());
      return;
    }
    body.triangles = std::make_unique<btTriangleMesh>();
    for (const geom::Triangle& t : mesh.triangles)
      body.triangles->addTriangle(scaled(mesh.vertices[t[0]]), scaled(mesh.vertices[t[1]]),
                                  scaled(mesh.vertices[t[2]]));
    body.surface = std::make_unique<btGImpactMeshShape>(body.triangles.get());
    body.surface->setMargin(0);
    body.surface->updateBound();
    body.object->setCollisionShape(body.surface.get());
  }

  /// GJK alone, which knows distances: how deep bodies are in each other, which takes most of the
  /// time and sometimes fails, is not asked for.
  static bool hulls_meet(const btConvexHullShape& x, const btTransform& at_x,
                         const btConvexHullShape& y, const btTransform& at_y) {
    btGjkEpaSolver2::sResults results;
    return !btGjkEpaSolver2::Distance(&x, at_x, &y, at_y, at_y.getOrigin() - at_x.getOrigin(),
                                      results);
  }

  /// As in a simulation: btCollisionWorld's test of a single pair does not know GImpact. It looks
  /// for all contacts.
  bool triangles_meet(Body& x, const btTransform& at_x, Body& y, const btTransform& at_y) {
    x.object->setWorldTransform(at_x);
    y.object->setWorldTransform(at_y);
    const btCollisionObjectWrapper of_x = wrapped(*x.object), of_y = wrapped(*y.object);
    btCollisionAlgorithm* algorithm =
        dispatcher_.findAlgorithm(&of_x, &of_y, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    if (algorithm == nullptr) return false;
    Contact contact(&of_x, &of_y);
    algorithm->processCollision(&of_x, &of_y, info_, &contact);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return contact.found;
  }

  std::vector<Thing> things_;
  double scale_ = 0;  ///< Bullet's units in one of ours; 0: nothing is placed yet
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDispatcherInfo info_;
};

}  // namespace

std::unique_ptr<Collider> make_bullet_collider(std::size_t things) {
  return std::make_unique<BulletCollider>(things);
}

std::string bullet_version() {
  constexpr int kMajor = BT_BULLET_VERSION / 100, kMinor = BT_BULLET_VERSION % 100;
  return "Bullet " + std::to_string(kMajor) + "." + std::to_string(kMinor);
}

}  // namespace kaboum::engines
