#pragma once

#include <kaboum/bcd/decompose.h>
#include <kaboum/geom/mesh.h>

#include <vector>

#include "support/shapes.h"

namespace kaboum::bcd::test {

/// Little effort, epsilon in percent of the diagonal.
inline DecomposeOptions quick(const geom::Mesh& mesh, double epsilon_percent,
                              std::size_t max_vertices = 64) {
  DecomposeOptions options;
  options.epsilon = 0.01 * epsilon_percent * geom::bounding_box(mesh).diagonal();
  options.max_vertices = max_vertices;
  options.effort = Effort::Fast;
  return options;
}

/// Prism over a simple polygon given counter-clockwise, from z = 0 to `height`.
inline geom::Mesh prism(const std::vector<std::array<double, 2>>& polygon, double height) {
  geom::Mesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double z : {0.0, height})
    for (const auto& p : polygon) mesh.vertices.emplace_back(p[0], p[1], z);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
  }
  // Ears.
  std::vector<std::uint32_t> rest(n);
  for (std::uint32_t i = 0; i < n; ++i) rest[i] = i;
  const auto area = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return (polygon[b][0] - polygon[a][0]) * (polygon[c][1] - polygon[a][1]) -
           (polygon[b][1] - polygon[a][1]) * (polygon[c][0] - polygon[a][0]);
  };
  while (rest.size() >= 3) {
    bool cut = false;
    for (std::size_t k = 0; k < rest.size() && !cut; ++k) {
      const std::uint32_t a = rest[k], b = rest[(k + 1) % rest.size()],
                          c = rest[(k + 2) % rest.size()];
      if (area(a, b, c) <= 0) continue;
      bool empty = true;
      for (const std::uint32_t p : rest)
        if (p != a && p != b && p != c)
          empty = empty && (area(a, b, p) < 0 || area(b, c, p) < 0 || area(c, a, p) < 0);
      if (!empty) continue;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({n + a, n + b, n + c});
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>((k + 1) % rest.size()));
      cut = true;
    }
    if (!cut) break;
  }
  return mesh;
}

}  // namespace kaboum::bcd::test
