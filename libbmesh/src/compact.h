#pragma once

#include <kaboum/geom/mesh.h>

#include <vector>

#include "connectivity.h"

namespace kaboum::bmesh {

/// The triangles left, in their order, with vertices numbered by first use.
///
/// @param source  receives, when not null, the vertex that each was.
inline geom::Mesh compact(const std::vector<geom::Vec3>& position, const Connectivity& mesh,
                          std::vector<std::uint32_t>* source = nullptr) {
  geom::Mesh out;
  std::size_t vertices = 0, triangles = 0;
  for (std::uint32_t v = 0; v < position.size(); ++v) vertices += mesh.used(v) ? 1 : 0;
  for (std::uint32_t t = 0; t < mesh.size(); ++t) triangles += mesh.alive(t) ? 1 : 0;
  out.vertices.reserve(vertices);
  out.triangles.reserve(triangles);
  if (source != nullptr) source->reserve(vertices);
  std::vector<std::uint32_t> renumbered(position.size(), Connectivity::kNone);
  for (std::uint32_t t = 0; t < mesh.size(); ++t) {
    if (!mesh.alive(t)) continue;
    geom::Triangle tri;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& r = renumbered[mesh[t][k]];
      if (r == Connectivity::kNone) {
        r = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(position[mesh[t][k]]);
        if (source != nullptr) source->push_back(mesh[t][k]);
      }
      tri[k] = r;
    }
    out.triangles.push_back(tri);
  }
  return out;
}

}  // namespace kaboum::bmesh
