// ODE behind the interface of engines, to compare with.

#include <ode/ode.h>

#include <array>
#include <limits>

#include "engine.h"

namespace kaboum::collide {
namespace {

/// Everything as triangle meshes for ODE's OPCODE: its convex shapes test every edge against every
/// face, and miss containment.
class OdeEngine : public Engine {
 public:
  explicit OdeEngine(const Model& model) {
    static const int kStarted = dInitODE2(0);
    (void)kStarted;
    robot_ = dHashSpaceCreate(nullptr);
    scene_ = dHashSpaceCreate(nullptr);
    for (const Part& part : model.robot) {
      links_.push_back(part.link);
      geoms_.push_back(add(part.mesh, robot_));
    }
    for (const geom::Mesh& mesh : model.scene) {
      geom::Box3 box = geom::bounding_box(mesh);
      const geom::Vec3 size = box.max - box.min, centre = box.center();
      dGeomID id = dCreateBox(scene_, size.x(), size.y(), size.z());
      dGeomSetPosition(id, centre.x(), centre.y(), centre.z());
    }
  }
  ~OdeEngine() override {
    dSpaceDestroy(robot_);
    dSpaceDestroy(scene_);
    for (dTriMeshDataID data : data_) dGeomTriMeshDataDestroy(data);
  }
  OdeEngine(const OdeEngine&) = delete;
  OdeEngine& operator=(const OdeEngine&) = delete;

  void place(const std::vector<geom::Transform>& poses) override {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const geom::Transform& pose = poses[links_[i]];
      dGeomSetPosition(geoms_[i], pose.translation.x(), pose.translation.y(), pose.translation.z());
      dMatrix3 r{};
      for (int row = 0; row < 3; ++row)
        for (int c = 0; c < 3; ++c) r[4 * row + c] = pose.linear(row, c);
      dGeomSetRotation(geoms_[i], r);
    }
  }

  bool collide() override {
    bool found = false;
    dSpaceCollide2(reinterpret_cast<dGeomID>(robot_), reinterpret_cast<dGeomID>(scene_), &found,
                   [](void* data, dGeomID a, dGeomID b) {
                     bool& hit = *static_cast<bool*>(data);
                     std::array<dContactGeom, 1> contact;
                     if (!hit && dCollide(a, b, 1, contact.data(), sizeof(dContactGeom)) > 0)
                       hit = true;
                   });
    return found;
  }

  double distance() override { return std::numeric_limits<double>::quiet_NaN(); }

 private:
  dGeomID add(const geom::Mesh& mesh, dSpaceID space) {
    vertices_.emplace_back();
    indices_.emplace_back();
    for (const geom::Vec3& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) vertices_.back().push_back(v[k]);
    for (const geom::Triangle& t : mesh.triangles)
      indices_.back().insert(indices_.back().end(), t.begin(), t.end());
    dTriMeshDataID data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data, vertices_.back().data(), 3 * sizeof(double),
                                static_cast<int>(mesh.vertices.size()), indices_.back().data(),
                                static_cast<int>(indices_.back().size()), 3 * sizeof(dTriIndex));
    data_.push_back(data);
    return dCreateTriMesh(space, data, nullptr, nullptr, nullptr);
  }

  dSpaceID robot_, scene_;
  std::vector<std::uint32_t> links_;
  std::vector<dGeomID> geoms_;
  std::vector<dTriMeshDataID> data_;
  std::vector<std::vector<double>> vertices_;
  std::vector<std::vector<dTriIndex>> indices_;
};

}  // namespace

std::unique_ptr<Engine> make_ode(const Model& model) { return std::make_unique<OdeEngine>(model); }

}  // namespace kaboum::collide
