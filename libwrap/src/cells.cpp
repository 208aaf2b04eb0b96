// The lattice, and which of its cells the input meets: boxes of cells are halved as long as a
// triangle may meet them.
#include "cells.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>

#include "separation.h"

namespace kaboum::wrap {
namespace {

struct Block {
  std::array<int, 3> low, high;  ///< cells, the last one included
};

/// Whether a triangle may meet a closed box of cells: the axes of both, and their products.
class TriangleInCells {
 public:
  TriangleInCells(const Lattice& lattice, const std::array<Vec3, 3>& corners)
      : lattice_(lattice), origin_(corners[0]) {
    std::array<Vec3, 3> triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      triangle[i] = corners[i] - origin_;
      most_ = std::max(most_, triangle[i].cwiseAbs().maxCoeff());
    }
    std::size_t count = 0;
    const auto add = [&](const Vec3& n) { axes_[count++] = {n, range_along(n, triangle), {n, 0}}; };
    add(triangle[1].cross(triangle[2]));
    for (std::size_t i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) add(Vec3::Unit(k).cross(triangle[(i + 1) % 3] - triangle[i]));
    for (int k = 0; k < 3; ++k) add(Vec3::Unit(k));
  }

  [[nodiscard]] bool may_meet(const Block& block) const {
    const Vec3 low = lattice_.corner(block.low[0], block.low[1], block.low[2]) - origin_;
    const Vec3 high =
        lattice_.corner(block.high[0] + 1, block.high[1] + 1, block.high[2] + 1) - origin_;
    const double most = std::max({most_, low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()});
    return std::none_of(axes_.begin(), axes_.end(), [&](const Axis& axis) {
      Range range{0, 0};
      for (int k = 0; k < 3; ++k) {
        const double a = axis.n[k] * low[k], b = axis.n[k] * high[k];
        range.low += std::min(a, b);
        range.high += std::max(a, b);
      }
      return apart(axis.range, range, axis.margin.at(most));
    });
  }

 private:
  const Lattice& lattice_;
  Vec3 origin_;
  double most_ = 0;  ///< the largest |coordinate|
  std::array<Axis, 13> axes_;
};

void mark(const TriangleInCells& triangle, const Block& block, BitGrid& cells) {
  if (!triangle.may_meet(block)) return;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (block.high[k] - block.low[k] > block.high[axis] - block.low[axis]) axis = k;
  if (block.high[axis] == block.low[axis])
    return cells.set(block.low[0], block.low[1], block.low[2]);
  const int middle = (block.low[axis] + block.high[axis]) / 2;
  Block half = block;
  half.high[axis] = middle;
  mark(triangle, half, cells);
  half = block;
  half.low[axis] = middle + 1;
  mark(triangle, half, cells);
}

/// Largest integer i with i · side ≤ x; the product is exact, the quotient need not be.
std::int64_t below(double x, double side) {
  auto i = static_cast<std::int64_t>(std::floor(x / side));
  while (static_cast<double>(i) * side > x) --i;
  while (static_cast<double>(i + 1) * side <= x) ++i;
  return i;
}
/// Smallest integer i with i · side ≥ x.
std::int64_t above(double x, double side) { return -below(-x, side); }

}  // namespace

std::array<std::int64_t, 3> Lattice::cell_of(const Vec3& p) const {
  std::array<std::int64_t, 3> cell{};
  for (int k = 0; k < 3; ++k) cell[k] = below(p[k], side) - first[k];
  return cell;
}

double side_above(double least) {
  int exponent = 0;
  const double fraction = std::frexp(least, &exponent);  // in [1/2, 1)
  return std::ldexp(std::ceil(8 * fraction), exponent - 3);
}

Lattice lattice_round(const geom::Box3& box, double side, int border, bool float32,
                      std::size_t max_cells) {
  // i · side has as many bits as i and three more.
  const double most = float32 ? 0x1p21 : 0x1p48;
  Lattice lattice{.side = side};
  double cells = 1;
  for (int k = 0; k < 3; ++k) {
    const double reach = std::max(std::abs(box.min[k]), std::abs(box.max[k])) / side + border + 2;
    if (!(reach < most))
      throw Error(ErrorCode::InvalidInput,
                  float32 ? "the coordinates are too large for 32-bit numbers as fine as the wrap "
                            "needs; move the mesh to the origin, or choose double precision"
                          : "the coordinates are too large for a wrap so fine; move the mesh to "
                            "the origin");
    lattice.first[k] = above(box.min[k], side) - 1 - border;
    const std::int64_t last = below(box.max[k], side) + border;
    lattice.size[k] =
        static_cast<int>(std::min<std::int64_t>(last - lattice.first[k] + 1, 1 << 30));
    cells *= static_cast<double>(lattice.size[k]);
  }
  if (cells > static_cast<double>(max_cells))
    throw Error(ErrorCode::LimitReached, "a wrap so fine needs a lattice of more than " +
                                             std::to_string(max_cells) +
                                             " cells; seal larger gaps");
  return lattice;
}

BitGrid occupied_cells(const Lattice& lattice, const geom::Mesh& mesh) {
  BitGrid cells(lattice.size);
  for (const geom::Triangle& t : mesh.triangles) {
    const std::array<Vec3, 3> corners{mesh.vertices[t[0]], mesh.vertices[t[1]],
                                      mesh.vertices[t[2]]};
    geom::Box3 box;
    for (const Vec3& p : corners) box.extend(p);
    Block block{};
    for (int k = 0; k < 3; ++k) {
      block.low[k] = static_cast<int>(above(box.min[k], lattice.side) - 1 - lattice.first[k]);
      block.high[k] = static_cast<int>(below(box.max[k], lattice.side) - lattice.first[k]);
    }
    if (block.low == block.high) {  // all of it is in that cell
      cells.set(block.low[0], block.low[1], block.low[2]);
    } else {
      mark(TriangleInCells(lattice, corners), block, cells);
    }
  }
  return cells;
}

}  // namespace kaboum::wrap
