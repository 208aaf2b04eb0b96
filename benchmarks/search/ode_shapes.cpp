// Shapes in ODE: triangles in OPCODE's trees. Its convex shapes test every edge against every face,
// and miss containment.
#include <ode/ode.h>

#include <array>

#include "other_world.h"

namespace kaboum::search {
namespace {

class OdeShapes : public Shapes {
 public:
  explicit OdeShapes(std::size_t things) : shapes_(things) {
    static const int kStarted = dInitODE2(0);
    (void)kStarted;
  }
  ~OdeShapes() override {
    for (const std::vector<dGeomID>& shapes : shapes_)
      for (dGeomID shape : shapes) dGeomDestroy(shape);
    for (dTriMeshDataID data : data_) dGeomTriMeshDataDestroy(data);
  }
  OdeShapes(const OdeShapes&) = delete;
  OdeShapes& operator=(const OdeShapes&) = delete;

  void add(std::size_t thing, const geom::Mesh& mesh) override {
    std::vector<double>& vertices = vertices_.emplace_back();
    std::vector<dTriIndex>& indices = indices_.emplace_back();
    for (const geom::Vec3& v : mesh.vertices) vertices.insert(vertices.end(), v.begin(), v.end());
    for (const geom::Triangle& t : mesh.triangles)
      indices.insert(indices.end(), t.begin(), t.end());
    data_.push_back(dGeomTriMeshDataCreate());
    dGeomTriMeshDataBuildDouble(data_.back(), vertices.data(), 3 * sizeof(double),
                                static_cast<int>(mesh.vertices.size()), indices.data(),
                                static_cast<int>(indices.size()), 3 * sizeof(dTriIndex));
    shapes_[thing].push_back(dCreateTriMesh(nullptr, data_.back(), nullptr, nullptr, nullptr));
  }

  void put(std::size_t thing, const geom::Transform& pose) override {
    dMatrix3 r{};
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c) r[4 * row + c] = pose.linear(row, c);
    for (dGeomID shape : shapes_[thing]) {
      dGeomSetPosition(shape, pose.translation.x(), pose.translation.y(), pose.translation.z());
      dGeomSetRotation(shape, r);
    }
  }

  bool meet(std::size_t a, std::size_t b) override {
    for (dGeomID x : shapes_[a])
      for (dGeomID y : shapes_[b]) {
        std::array<dReal, 6> of_x{}, of_y{};  // least and most of each axis
        dGeomGetAABB(x, of_x.data());
        dGeomGetAABB(y, of_y.data());
        bool apart = false;
        for (std::size_t k = 0; k < 6; k += 2)
          apart = apart || of_x[k] > of_y[k + 1] || of_y[k] > of_x[k + 1];
        dContactGeom contact;
        if (!apart && dCollide(x, y, 1, &contact, sizeof contact) > 0) return true;
      }
    return false;
  }

 private:
  std::vector<std::vector<dGeomID>> shapes_;
  std::vector<dTriMeshDataID> data_;
  std::vector<std::vector<double>> vertices_;
  std::vector<std::vector<dTriIndex>> indices_;
};

}  // namespace

std::unique_ptr<Shapes> ode_shapes(std::size_t things) {
  return std::make_unique<OdeShapes>(things);
}

}  // namespace kaboum::search
