// Things in ODE: triangles in OPCODE's trees. Its convex shapes test every edge against every face,
// and miss containment, so that bodies of sets are triangles, too: what lies wholly inside is not
// seen.

#include <kaboum/base/error.h>
#include <kaboum/geom/body_polytopes.h>
#include <ode/ode.h>

#include <mutex>
#include <vector>

#include "adapters.h"

namespace kaboum::engines {
namespace {

class OdeCollider : public Collider {
 public:
  explicit OdeCollider(std::size_t things) : things_(things) {
    static std::once_flag started;
    std::call_once(started, [] { dInitODE2(0); });
  }
  ~OdeCollider() override {
    for (Thing& thing : things_) clear(thing);
  }
  OdeCollider(const OdeCollider&) = delete;
  OdeCollider& operator=(const OdeCollider&) = delete;

  void add(std::size_t thing, const geom::ConvexBody& body) override {
    add(thing, geom::surface_of(body));
  }

  void add(std::size_t thing, const geom::Mesh& mesh) override {
    Thing& t = things_[thing];
    clear(t);
    const auto first = static_cast<dTriIndex>(t.vertices.size() / 3);
    for (const geom::Vec3& v : mesh.vertices)
      t.vertices.insert(t.vertices.end(), v.begin(), v.end());
    for (const geom::Triangle& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle) t.indices.push_back(first + v);
  }

  void put(std::size_t thing, const geom::Transform& pose) override {
    Thing& t = things_[thing];
    if (t.indices.empty()) return;
    if (t.shape == nullptr) build(t);
    dMatrix3 r{};
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c) r[4 * row + c] = pose.linear(row, c);
    dGeomSetPosition(t.shape, pose.translation.x(), pose.translation.y(), pose.translation.z());
    dGeomSetRotation(t.shape, r);
  }

  bool meet(std::size_t a, std::size_t b) override {
    // Each thread that asks has data of its own.
    thread_local const int kJoined = dAllocateODEDataForThread(dAllocateMaskAll);
    ensure(kJoined != 0, "ODE has memory for this thread");
    if (things_[a].shape == nullptr || things_[b].shape == nullptr) return false;
    dContactGeom contact;
    return dCollide(things_[a].shape, things_[b].shape, 1, &contact, sizeof contact) > 0;
  }

 private:
  /// All triangles of a thing in one tree.
  struct Thing {
    std::vector<double> vertices;
    std::vector<dTriIndex> indices;
    dTriMeshDataID data = nullptr;
    dGeomID shape = nullptr;
  };

  static void build(Thing& t) {
    t.data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(t.data, t.vertices.data(), 3 * sizeof(double),
                                static_cast<int>(t.vertices.size() / 3), t.indices.data(),
                                static_cast<int>(t.indices.size()), 3 * sizeof(dTriIndex));
    t.shape = dCreateTriMesh(nullptr, t.data, nullptr, nullptr, nullptr);
  }

  static void clear(Thing& t) {
    if (t.shape != nullptr) dGeomDestroy(t.shape);
    if (t.data != nullptr) dGeomTriMeshDataDestroy(t.data);
    t.shape = nullptr;
    t.data = nullptr;
  }

  std::vector<Thing> things_;
};

}  // namespace

std::unique_ptr<Collider> make_ode_collider(std::size_t things) {
  return std::make_unique<OdeCollider>(things);
}

std::string ode_version() { return std::string("ODE ") + dODE_VERSION; }

}  // namespace kaboum::engines
