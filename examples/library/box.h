#pragma once

#include <kaboum/geom/mesh.h>

/// A box with faces that turn outwards, for the examples. [the mesh's unit]
inline kaboum::geom::Mesh box(const kaboum::geom::Vec3& low, const kaboum::geom::Vec3& high) {
  kaboum::geom::Mesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back((corner & 1) != 0 ? high.x() : low.x(),
                               (corner & 2) != 0 ? high.y() : low.y(),
                               (corner & 4) != 0 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}
