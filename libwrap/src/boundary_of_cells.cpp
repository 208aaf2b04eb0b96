// The boundary of a union of cells as a surface: faces, and fans of faces at each corner.
#include "boundary_of_cells.h"

#include <array>
#include <bit>
#include <unordered_map>

namespace kaboum::wrap {
namespace {

/// Of the eight cells round a corner of the lattice, cell k lies at +x if k & 1, +y if k & 2, +z if
/// k & 4. A face at the corner lies between two cells that differ in one bit: it is called by the
/// lower cell and the axis.
constexpr int face(int low, int axis) { return 3 * low + axis; }
constexpr int kFaces = 24;

using Fans = std::array<std::int8_t, kFaces>;

/// The fan that each face belongs to, of the faces between outer and other cells.
Fans fans_of(unsigned outside) {
  const auto out = [&](int cell) { return ((outside >> cell) & 1U) != 0; };
  std::array<int, kFaces> parent{};
  for (int f = 0; f < kFaces; ++f) parent[f] = f;
  const auto root = [&](int f) {
    while (parent[f] != f) f = parent[f];
    return f;
  };
  const auto face_between = [](int a, int b) {
    return face(a & b, std::countr_zero(static_cast<unsigned>(a ^ b)));
  };
  // Each half-axis from the corner is an edge with four cells round it.
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const int u = 1 << ((axis + 1) % 3), v = 1 << ((axis + 2) % 3), base = side << axis;
      const std::array<int, 4> cell{base, base | u, base | u | v, base | v};
      std::array<int, 4> wall{};  // between cell i and the next one; −1: none
      int walls = 0;
      for (int i = 0; i < 4; ++i) {
        const int next = cell[(i + 1) % 4];
        wall[i] = out(cell[i]) != out(next) ? face_between(cell[i], next) : -1;
        walls += wall[i] >= 0 ? 1 : 0;
      }
      int first = -1;
      for (int i = 0; i < 4; ++i) {
        if (wall[i] < 0) continue;
        if (walls == 2) {
          if (first >= 0) parent[root(wall[i])] = root(first);
          first = wall[i];
        } else if (out(cell[(i + 1) % 4])) {
          parent[root(wall[i])] = root(wall[(i + 1) % 4]);
        }
      }
    }
  }
  Fans fans{};
  for (int f = 0; f < kFaces; ++f) fans[f] = static_cast<std::int8_t>(root(f));
  return fans;
}

class BoundaryBuilder {
 public:
  BoundaryBuilder(const Lattice& lattice, const BitGrid& outside)
      : lattice_(lattice), outside_(outside) {
    for (unsigned mask = 0; mask < fans_.size(); ++mask) fans_[mask] = fans_of(mask);
  }

  /// The face between a cell and the next one along the axis.
  void add_face(const std::array<int, 3>& cell, int axis, bool outside_above) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<std::uint32_t, 4> corner{};
    for (int i = 0; i < 4; ++i) {
      std::array<int, 3> at = cell;
      at[axis] += 1;
      // The cell seen from the corner: behind it along the axis; along u and v, on the other side.
      const int du = i == 1 || i == 2 ? 1 : 0, dv = i >= 2 ? 1 : 0;
      at[u] += du;
      at[v] += dv;
      corner[i] = vertex(at, face(((1 - du) << u) | ((1 - dv) << v), axis));
    }
    if (!outside_above) std::swap(corner[1], corner[3]);
    mesh_.triangles.push_back({corner[0], corner[1], corner[2]});
    mesh_.triangles.push_back({corner[0], corner[2], corner[3]});
  }

  geom::Mesh take() { return std::move(mesh_); }

 private:
  struct Corner {
    unsigned outside = 0;
    std::array<std::uint32_t, kFaces> of_fan{};  ///< vertex number and one; 0: none yet
  };

  std::uint32_t vertex(const std::array<int, 3>& at, int face) {
    const auto [x, y, z] = at;
    const std::uint64_t key =
        (static_cast<std::uint64_t>(z) * static_cast<std::uint64_t>(lattice_.size[1] + 1) +
         static_cast<std::uint64_t>(y)) *
            static_cast<std::uint64_t>(lattice_.size[0] + 1) +
        static_cast<std::uint64_t>(x);
    const auto [found, fresh] = corners_.try_emplace(key);
    Corner& corner = found->second;
    if (fresh) {
      for (int k = 0; k < 8; ++k)
        if (outside_.get(x - 1 + (k & 1), y - 1 + ((k >> 1) & 1), z - 1 + (k >> 2)))
          corner.outside |= 1U << k;
    }
    std::uint32_t& number = corner.of_fan[fans_[corner.outside][face]];
    if (number == 0) {
      mesh_.vertices.push_back(lattice_.corner(x, y, z));
      number = static_cast<std::uint32_t>(mesh_.vertices.size());
    }
    return number - 1;
  }

  const Lattice& lattice_;
  const BitGrid& outside_;
  std::array<Fans, 256> fans_{};
  std::unordered_map<std::uint64_t, Corner> corners_;
  geom::Mesh mesh_;
};

}  // namespace

geom::Mesh boundary_of_cells(const Lattice& lattice, const BitGrid& outside) {
  BoundaryBuilder builder(lattice, outside);
  const auto [nx, ny, nz] = lattice.size;
  const auto words = static_cast<int>(outside.row(0, 0).size());
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      const auto row = outside.row(y, z);
      for (int axis = 0; axis < 3; ++axis) {
        if ((axis == 1 && y + 1 == ny) || (axis == 2 && z + 1 == nz)) continue;
        for (int w = 0; w < words; ++w) {
          const auto at = static_cast<std::size_t>(w);
          BitGrid::Word next = axis == 1   ? outside.row(y + 1, z)[at]
                               : axis == 2 ? outside.row(y, z + 1)[at]
                                           : row[at] >> 1;
          if (axis == 0 && w + 1 < words) next |= row[at + 1] << (BitGrid::kBits - 1);
          for (BitGrid::Word walls = row[at] ^ next; walls != 0; walls &= walls - 1) {
            const int x = w * BitGrid::kBits + std::countr_zero(walls);
            if (x >= nx || (axis == 0 && x + 1 >= nx)) continue;
            builder.add_face({x, y, z}, axis, !outside.get(x, y, z));
          }
        }
      }
    }
  }
  return builder.take();
}

}  // namespace kaboum::wrap
