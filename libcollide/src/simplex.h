#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>

namespace kaboum::collide::detail {

/// Differences of points of two bodies, up to four.
struct Simplex {
  struct Vertex {
    geom::Vec3 w;  ///< rounded: point of b minus point of a
    std::uint32_t a = 0, b = 0;
  };
  std::array<Vertex, 4> vertex;
  std::array<double, 4> share{};  ///< ≥ 0; their sum is 1, rounded
  int size = 0;

  [[nodiscard]] bool has(std::uint32_t a, std::uint32_t b) const {
    for (int i = 0; i < size; ++i)
      if (vertex[i].a == a && vertex[i].b == b) return true;
    return false;
  }
  void add(const Vertex& v) { vertex[size++] = v; }
};

/// Reduces the simplex to the corners whose hull has its point nearest to the origin, and sets
/// their shares. In rounded arithmetic: whoever uses it checks what comes of it.
/// @return that point: Σ share · w. Four corners are left only where they seem to hold the origin.
geom::Vec3 reduce_to_nearest(Simplex& simplex);

}  // namespace kaboum::collide::detail
