#include "obstacle.h"

namespace kaboum::wrap {

Obstacle::Obstacle(const geom::Mesh& mesh, double clearance) : query_(mesh), clearance_(clearance) {
  normal_.reserve(mesh.triangles.size());
  for (const geom::Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    normal_.emplace_back((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a));
  }
}

bool Obstacle::clear(std::span<const Tetrahedron> tetrahedra) const {
  if (tetrahedra.empty()) return true;
  thread_local Cones cones;
  cones.set(tetrahedra, clearance_);
  bool clear = true;
  query_.hierarchy().traverse([&](const geom::Box3& box) { return clear && cones.may_meet(box); },
                              [&](std::uint32_t triangle) {
                                clear = clear &&
                                        cones.clear_of(query_.corners(triangle), normal_[triangle]);
                              });
  return clear;
}

}  // namespace kaboum::wrap
