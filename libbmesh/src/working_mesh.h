#pragma once

#include <kaboum/geom/solid_mesh.h>

#include <vector>

#include <kaboum/base/parallel.h>
#include "connectivity.h"
#include "quadric.h"

namespace kaboum::bmesh {

/// The mesh that decimation and optimisation work on.
struct WorkingMesh {
  explicit WorkingMesh(const geom::SolidMesh& input)
      : WorkingMesh(input.mesh().vertices, input.border(), input.mesh().triangles) {}

  WorkingMesh(std::vector<Vec3> vertices, std::vector<char> may_not_move,
              std::vector<geom::Triangle> triangles)
      : position(std::move(vertices)),
        border(std::move(may_not_move)),
        mesh(position.size(), std::move(triangles)),
        normal(mesh.size()) {
    parallel_for_light(mesh.size(),
                       [&](std::size_t t) { update_normal(static_cast<std::uint32_t>(t)); });
  }

  void update_normal(std::uint32_t t) {
    const geom::Triangle& tri = mesh[t];
    const Vec3& a = position[tri[0]];
    const Vec3 n = (position[tri[1]] - a).cross(position[tri[2]] - a);
    const double length = n.norm();
    normal[t] = length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
  }

  void update_normals_around(std::uint32_t v) {
    mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t) { update_normal(t); });
  }

  std::vector<Vec3> position;
  std::vector<char> border;  // may not move
  Connectivity mesh;
  std::vector<Vec3> normal;  // unit, or zero for triangles without area
};

}  // namespace kaboum::bmesh
