#pragma once

#include <kaboum/filter/batch_checker.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model.h"

namespace kaboum::filter::detail {

/// Memory of the vector code: of one thread.
class LaneMemory {
 public:
  explicit LaneMemory(const Model& model);

  float* floats();  ///< aligned for vectors
  std::uint32_t* near() { return near_.data(); }
  unsigned char* ready() { return ready_.data(); }

 private:
  std::unique_ptr<float[]> floats_;
  std::vector<std::uint32_t> near_;
  std::vector<unsigned char> ready_;
};

/// What of rows is looked for.
enum class Look : std::uint8_t {
  All,       ///< every row's answer
  One,       ///< one in contact is enough: the others may be open then
  Contacts,  ///< one in contact with an obstacle: all else is open
  Apart,     ///< rows that are free: others are open
};

/// Pairs that rows are open for: numbers of Model::items.
class OpenPairs {
 public:
  static constexpr std::size_t kMost = 7;  ///< of a row

  explicit OpenPairs(std::size_t rows) : numbers_(rows * (kMost + 1)) {}

  /// Those of a row that is open; nullopt: any pair may be.
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> of(std::size_t row) const {
    const std::uint32_t* first = numbers_.data() + row * (kMost + 1);
    if (first[0] == 0 || first[0] > kMost) return std::nullopt;
    return std::span(first + 1, first[0]);
  }
  /// A count for each row, which is above kMost where there are more, and the numbers.
  [[nodiscard]] std::uint32_t* data() { return numbers_.data(); }

 private:
  std::vector<std::uint32_t> numbers_;
};

/// A pair that a row is open for.
struct Suspect {
  static constexpr std::uint32_t kNone = ~0U;
  std::uint32_t pair = kNone;  ///< number of Model::items
  bool unparted = false;       ///< at the row itself, too, no direction parts some of its bodies
};

/// Rows are in blocks of as many as the widest vectors have lanes: for each variable its values of
/// all rows of a block, one after the other. The last block is full.
inline constexpr std::size_t kBlock = 16;
inline constexpr std::size_t place_of(std::size_t row, std::size_t variable,
                                      std::size_t variables) {
  return (row / kBlock * variables + variable) * kBlock + row % kBlock;
}
inline constexpr std::size_t blocks_size(std::size_t rows, std::size_t variables) {
  return (rows + kBlock - 1) / kBlock * kBlock * variables;
}

/// Decides rows of values, several at a time. @pre the processor has the instructions.
/// @param rows  in blocks. @pre those after the last one are finite
/// @param ways  null; or of each row a vector w, in blocks: free is then what is so at row + s·w
/// for
///   all |s| ≤ 1, up to what put_stretch rounds, in contact what is so at the row
/// @param slack  free is what is apart by more than that besides the margin; rounded up [length]
/// @param look  what is looked for
/// @param pairs  is told of all rows, unless it is null. @pre all answers are looked for
/// @param suspects  null; or of each row none before: where there are ways, one is named
void filter_blocks(const Model& model, Instructions set, const double* rows, const double* ways,
                   std::size_t count, LaneMemory& memory, BatchChecker::Answer* answers,
                   float slack = 0, Look look = Look::All, OpenPairs* pairs = nullptr,
                   Suspect* suspects = nullptr);

/// The same of rows one after the other, and all their answers.
void filter_rows(const Model& model, Instructions set, const double* rows, const double* ways,
                 std::size_t count, LaneMemory& memory, BatchChecker::Answer* answers,
                 float slack = 0);

/// Rows one after the other, in blocks.
std::vector<double> in_blocks(const double* rows, std::size_t count, std::size_t variables);

/// Centres of the outer balls for each row, x, y, z; for tests.
void place_outer_balls(const Model& model, Instructions set, const double* rows, std::size_t count,
                       LaneMemory& memory, float* centers);

/// Sine and cosine as the vector code computes them; for tests.
void sines_of(Instructions set, const double* angles, std::size_t count, float* sines,
              float* cosines);

}  // namespace kaboum::filter::detail
