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
  std::array<double, 4> share;  ///< ≥ 0; their sum is 1, rounded. Of corners that were kept
  int size = 0;

  [[nodiscard]] bool has(std::uint32_t a, std::uint32_t b) const {
    for (int i = 0; i < size; ++i)
      if (vertex[i].a == a && vertex[i].b == b) return true;
    return false;
  }
};

/// Some corners of a simplex, ascending, with shares as there, and their point Σ share · w.
struct Face {
  std::array<int, 4> corner{0, 1, 2, 3};
  std::array<double, 4> share{};
  int size = 0;
  geom::Vec3 point;
};

/// The corners whose hull has the point of the simplex that is nearest to the origin. In rounded
/// arithmetic: whoever uses it checks what comes of it. All four only where they seem to hold the
/// origin.
Face nearest_face(const Simplex& simplex);

/// Leaves out the other corners.
void keep(Simplex& simplex, const Face& face);

}  // namespace kaboum::collide::detail
