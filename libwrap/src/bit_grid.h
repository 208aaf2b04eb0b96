#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::wrap {

/// A box of cells, one bit each. Rows run along x.
class BitGrid {
 public:
  using Word = std::uint64_t;
  static constexpr int kBits = 64;

  explicit BitGrid(const std::array<int, 3>& size)
      : size_(size),
        words_((static_cast<std::size_t>(size[0]) + kBits - 1) / kBits),
        bits_(words_ * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2])) {}

  [[nodiscard]] const std::array<int, 3>& size() const { return size_; }
  [[nodiscard]] bool holds(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < size_[0] && y < size_[1] && z < size_[2];
  }
  /// @pre holds(x, y, z)
  [[nodiscard]] bool get(int x, int y, int z) const {
    return ((row(y, z)[static_cast<std::size_t>(x) / kBits] >> (x % kBits)) & 1U) != 0;
  }
  void set(int x, int y, int z) {
    row(y, z)[static_cast<std::size_t>(x) / kBits] |= Word{1} << (x % kBits);
  }
  [[nodiscard]] std::span<const Word> row(int y, int z) const {
    return {bits_.data() + at(y, z), words_};
  }
  [[nodiscard]] std::span<Word> row(int y, int z) { return {bits_.data() + at(y, z), words_}; }

 private:
  [[nodiscard]] std::size_t at(int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(y)) *
           words_;
  }

  std::array<int, 3> size_;
  std::size_t words_;
  std::vector<Word> bits_;
};

/// All cells within a ball of any cell that is set: of two cells, the distance of their nearest
/// points counts, in sides of a cell, and must be below `radius`.
BitGrid dilated(const BitGrid& cells, double radius);

/// The cells that are connected through faces with the cell (0, 0, 0), without passing `blocked`.
BitGrid flooded(const BitGrid& blocked);

/// How many cells around a cell `dilated` reaches at most, along an axis.
int reach(double radius);

}  // namespace kaboum::wrap
