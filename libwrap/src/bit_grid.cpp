// Dilation and flooding of cells, 64 at a time.
#include "bit_grid.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace kaboum::wrap {
namespace {

using Word = BitGrid::Word;

double gap(int offset) { return std::max(std::abs(offset) - 1, 0); }

/// out |= row moved by `by` cells along x.
void add_moved(std::span<const Word> row, int by, std::span<Word> out) {
  const int words = by / BitGrid::kBits, bits = by % BitGrid::kBits;
  const auto n = static_cast<int>(row.size());
  for (int i = 0; i < n; ++i) {
    // `by` may be negative: then bits come from the words above.
    const auto word = [&](int k) { return k >= 0 && k < n ? row[static_cast<std::size_t>(k)] : 0; };
    const int from = i - words;
    Word w = word(from);
    if (bits > 0) w = (w << bits) | (word(from - 1) >> (BitGrid::kBits - bits));
    if (bits < 0) w = (w >> -bits) | (word(from + 1) << (BitGrid::kBits + bits));
    out[static_cast<std::size_t>(i)] |= w;
  }
}

/// Seeds spread within runs of `free` bits of one word, both ways (Kogge and Stone's carries).
Word spread(Word seed, Word free) {
  Word up = seed & free, run = free;
  for (int k = 1; k < BitGrid::kBits; k *= 2) {
    up |= run & (up << k);
    run &= run << k;
  }
  Word down = seed & free;
  run = free;
  for (int k = 1; k < BitGrid::kBits; k *= 2) {
    down |= run & (down >> k);
    run &= run >> k;
  }
  return up | down;
}

/// Takes away the bits beyond the last cell of each row.
void trim(BitGrid& cells) {
  const auto [nx, ny, nz] = cells.size();
  const int left = nx % BitGrid::kBits;
  if (left == 0) return;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y) cells.row(y, z).back() &= (Word{1} << left) - 1;
}

/// Spreads the row's bits along runs that are not blocked, nor beyond the last cell.
void spread_row(std::span<Word> row, std::span<const Word> blocked, Word last) {
  row.back() &= last;
  Word carry = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const Word free = ~blocked[i] & (i + 1 == row.size() ? last : ~Word{0});
    row[i] = spread(row[i] | carry, free);
    carry = row[i] >> (BitGrid::kBits - 1);
  }
  carry = 0;
  for (std::size_t i = row.size(); i-- > 0;) {
    const Word free = ~blocked[i] & (i + 1 == row.size() ? last : ~Word{0});
    row[i] = spread(row[i] | carry, free);
    carry = row[i] << (BitGrid::kBits - 1);
  }
}

}  // namespace

int reach(double radius) {
  int most = 0;
  while (gap(most + 1) < radius) ++most;
  return most;
}

BitGrid dilated(const BitGrid& cells, double radius) {
  const int most = reach(radius);
  const int ny = cells.size()[1], nz = cells.size()[2];
  BitGrid result(cells.size());
  // Rows widened along x, by each of the widths that occur.
  for (int width = 0; width <= most; ++width) {
    std::vector<std::array<int, 2>> rows;
    for (int dz = -most; dz <= most; ++dz) {
      for (int dy = -most; dy <= most; ++dy) {
        const double rest = radius * radius - gap(dy) * gap(dy) - gap(dz) * gap(dz);
        int e = -1;
        while (gap(e + 1) * gap(e + 1) < rest) ++e;
        if (e == width) rows.push_back({dy, dz});
      }
    }
    if (rows.empty()) continue;
    std::vector<Word> wide(cells.row(0, 0).size());
    for (int z = 0; z < nz; ++z) {
      for (int y = 0; y < ny; ++y) {
        const std::span<const Word> row = cells.row(y, z);
        if (std::all_of(row.begin(), row.end(), [](Word w) { return w == 0; })) continue;
        std::fill(wide.begin(), wide.end(), 0);
        for (int by = -width; by <= width; ++by) add_moved(row, by, wide);
        for (const auto& [dy, dz] : rows) {
          if (y + dy < 0 || y + dy >= ny || z + dz < 0 || z + dz >= nz) continue;
          const std::span<Word> out = result.row(y + dy, z + dz);
          for (std::size_t i = 0; i < out.size(); ++i) out[i] |= wide[i];
        }
      }
    }
  }
  trim(result);
  return result;
}

BitGrid flooded(const BitGrid& blocked) {
  const auto [nx, ny, nz] = blocked.size();
  BitGrid result(blocked.size());
  const int width = ny;
  const auto index = [&](int y, int z) { return static_cast<std::size_t>(z) * width + y; };
  std::vector<char> waits(static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz), 0);
  std::deque<std::array<int, 2>> queue;
  if (blocked.get(0, 0, 0)) return result;
  const int left = nx % BitGrid::kBits;
  const Word last = left == 0 ? ~Word{0} : (Word{1} << left) - 1;
  result.set(0, 0, 0);
  spread_row(result.row(0, 0), blocked.row(0, 0), last);
  queue.push_back({0, 0});
  std::vector<Word> before;
  while (!queue.empty()) {
    const auto [y, z] = queue.front();
    queue.pop_front();
    waits[index(y, z)] = 0;
    const std::span<const Word> row = result.row(y, z);
    for (const auto& [dy, dz] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const int v = y + dy, w = z + dz;
      if (v < 0 || v >= ny || w < 0 || w >= nz) continue;
      const std::span<Word> next = result.row(v, w);
      const std::span<const Word> walls = blocked.row(v, w);
      bool new_ones = false;
      for (std::size_t i = 0; i < next.size(); ++i)
        new_ones = new_ones || (row[i] & ~walls[i] & ~next[i]) != 0;
      if (!new_ones) continue;
      for (std::size_t i = 0; i < next.size(); ++i) next[i] |= row[i] & ~walls[i];
      spread_row(next, walls, last);
      if (waits[index(v, w)] == 0) queue.push_back({v, w});
      waits[index(v, w)] = 1;
    }
  }
  return result;
}

}  // namespace kaboum::wrap
