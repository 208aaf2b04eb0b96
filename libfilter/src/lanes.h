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
  unsigned char* ready() { return ready_.data(); }

 private:
  std::unique_ptr<float[]> floats_;
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

/// Decides rows of values, several at a time. @pre the processor has the instructions.
/// @param widths  null; or for each row how far every variable goes from its value, to both sides:
///   free is then what is so at all these values, in contact what is so at the row's own
/// @param slack  free is what is apart by more than that besides the margin; rounded up [length]
/// @param look  what is looked for
/// @param pairs  is told of all rows, unless it is null. @pre all answers are looked for
void filter_rows(const Model& model, Instructions set, const double* rows, const double* widths,
                 std::size_t count, LaneMemory& memory, BatchChecker::Answer* answers,
                 float slack = 0, Look look = Look::All, OpenPairs* pairs = nullptr);

/// Centres of the outer balls for each row, x, y, z; for tests.
void place_outer_balls(const Model& model, Instructions set, const double* rows, std::size_t count,
                       LaneMemory& memory, float* centers);

/// Sine and cosine as the vector code computes them; for tests.
void sines_of(Instructions set, const double* angles, std::size_t count, float* sines,
              float* cosines);

}  // namespace kaboum::filter::detail
