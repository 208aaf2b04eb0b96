// Cells by the word are the same as cells one by one.
#include "bit_grid.h"

#include <gtest/gtest.h>
#include <kaboum/base/random.h>

#include <algorithm>
#include <vector>

namespace kaboum::wrap {
namespace {

BitGrid random_cells(const std::array<int, 3>& size, double share, std::uint64_t seed) {
  Random random(seed);
  BitGrid cells(size);
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x)
        if (x + y + z > 0 && random.between(0, 1) < share) cells.set(x, y, z);
  return cells;
}

template <class Visit>
void for_each_cell(const BitGrid& cells, Visit&& visit) {
  for (int z = 0; z < cells.size()[2]; ++z)
    for (int y = 0; y < cells.size()[1]; ++y)
      for (int x = 0; x < cells.size()[0]; ++x) visit(x, y, z);
}

double gap(int a, int b) { return std::max(std::abs(a - b) - 1, 0); }

TEST(BitGrid, DilationIsThatOfEachCell) {
  for (const double radius : {0.5, 1.0, 1.2, 2.0, 2.9}) {
    const BitGrid cells = random_cells({70, 9, 11}, 0.01, 7), wide = dilated(cells, radius);
    std::vector<std::array<int, 3>> set;
    for_each_cell(cells, [&](int x, int y, int z) {
      if (cells.get(x, y, z)) set.push_back({x, y, z});
    });
    for_each_cell(cells, [&](int x, int y, int z) {
      const bool expected = std::any_of(set.begin(), set.end(), [&](const auto& c) {
        const double a = gap(c[0], x), b = gap(c[1], y), d = gap(c[2], z);
        return a * a + b * b + d * d < radius * radius;
      });
      ASSERT_EQ(wide.get(x, y, z), expected) << x << ' ' << y << ' ' << z << " at " << radius;
    });
  }
}

TEST(BitGrid, FloodReachesWhatASearchReaches) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const BitGrid walls = random_cells({130, 13, 12}, 0.55 + 0.05 * seed, seed);
    const BitGrid flood = flooded(walls);
    BitGrid expected(walls.size());
    std::vector<std::array<int, 3>> stack{{0, 0, 0}};
    expected.set(0, 0, 0);
    while (!stack.empty()) {
      const auto [x, y, z] = stack.back();
      stack.pop_back();
      for (int k = 0; k < 6; ++k) {
        std::array<int, 3> next{x, y, z};
        next[k / 2] += k % 2 == 0 ? 1 : -1;
        const auto [u, v, w] = next;
        if (!walls.holds(u, v, w) || walls.get(u, v, w) || expected.get(u, v, w)) continue;
        expected.set(u, v, w);
        stack.push_back(next);
      }
    }
    for_each_cell(walls, [&](int x, int y, int z) {
      ASSERT_EQ(flood.get(x, y, z), expected.get(x, y, z)) << x << ' ' << y << ' ' << z;
    });
  }
}

}  // namespace
}  // namespace kaboum::wrap
