#pragma once

#include <kaboum/geom/mesh.h>

#include <cmath>
#include <cstdint>
#include <numbers>

/// Sphere of latitude rings; the poles have valence `segments`.
inline kaboum::geom::Mesh sphere(std::uint32_t segments, std::uint32_t rings) {
  kaboum::geom::Mesh mesh;
  mesh.vertices.emplace_back(0, 0, -1);
  mesh.vertices.emplace_back(0, 0, 1);
  for (std::uint32_t r = 0; r < rings; ++r) {
    const double latitude = std::numbers::pi * ((r + 1.0) / (rings + 1.0) - 0.5);
    for (std::uint32_t s = 0; s < segments; ++s) {
      const double longitude = 2 * std::numbers::pi * s / segments;
      mesh.vertices.emplace_back(std::cos(latitude) * std::cos(longitude),
                                 std::cos(latitude) * std::sin(longitude), std::sin(latitude));
    }
  }
  const auto at = [&](std::uint32_t r, std::uint32_t s) { return 2 + r * segments + s % segments; };
  for (std::uint32_t s = 0; s < segments; ++s) {
    mesh.triangles.push_back({0, at(0, s + 1), at(0, s)});
    mesh.triangles.push_back({1, at(rings - 1, s), at(rings - 1, s + 1)});
    for (std::uint32_t r = 0; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r, s + 1), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r + 1, s)});
    }
  }
  return mesh;
}
