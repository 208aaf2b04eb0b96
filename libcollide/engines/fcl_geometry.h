#pragma once

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/convex.h>
#include <kaboum/geom/mesh.h>

#include <memory>
#include <vector>

namespace kaboum::collide {

/// A mesh as FCL wants it: a tree of its triangles, or a convex body.
inline std::shared_ptr<fcl::CollisionGeometryd> fcl_geometry(const geom::Mesh& mesh, bool convex) {
  if (convex) {
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>(mesh.vertices);
    auto faces = std::make_shared<std::vector<int>>();
    for (const geom::Triangle& t : mesh.triangles) {
      faces->push_back(3);
      for (const std::uint32_t v : t) faces->push_back(static_cast<int>(v));
    }
    return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(mesh.triangles.size()), faces);
  }
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const geom::Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace kaboum::collide
