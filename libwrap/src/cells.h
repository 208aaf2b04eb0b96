#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>

#include "bit_grid.h"

namespace kaboum::wrap {

using geom::Vec3;

/// A lattice of cubes whose corners are multiples of `side`, exactly: i · side is a double, and
/// where float32 numbers are wished, one of those.
struct Lattice {
  double side = 0;
  std::array<std::int64_t, 3> first{};  ///< corner of the cell (0, 0, 0), in sides
  std::array<int, 3> size{};            ///< cells along each axis

  [[nodiscard]] Vec3 corner(int x, int y, int z) const {
    return {static_cast<double>(first[0] + x) * side, static_cast<double>(first[1] + y) * side,
            static_cast<double>(first[2] + z) * side};
  }
  /// The cell that a point lies in; one of them where it lies on a face.
  [[nodiscard]] std::array<std::int64_t, 3> cell_of(const Vec3& p) const;
};

/// The shortest side that is not below `least`, of one of the numbers 4, 5, 6, 7 times a power of
/// two.
double side_above(double least);

/// The lattice round a box, with `border` cells more on each side.
/// @throws Error as wrap()
Lattice lattice_round(const geom::Box3& box, double side, int border, bool float32,
                      std::size_t max_cells);

/// Marks every closed cell that a triangle meets, and perhaps some that it misses by rounding.
BitGrid occupied_cells(const Lattice& lattice, const geom::Mesh& mesh);

}  // namespace kaboum::wrap
