#pragma once

#include <kaboum/geom/mesh.h>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace kaboum::test {

/// Two tips of valence n over a ring that goes up and down by `height`: needles, the boxes of which
/// overlap.
inline geom::Mesh double_fan(std::uint32_t n, double height = 0.05) {
  geom::Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), i % 2 == 0 ? -height : height);
  }
  mesh.vertices.emplace_back(0, 0, 1);
  mesh.vertices.emplace_back(0, 0, -1);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n});
    mesh.triangles.push_back({j, i, n + 1});
  }
  return mesh;
}

}  // namespace kaboum::test
